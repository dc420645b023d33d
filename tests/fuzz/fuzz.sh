#!/usr/bin/env bash
# Fuzzes the C interface of libvox (libFuzzer), and the readers of VXA files and of configurations (atheris), all with
# the address and undefined-behavior sanitizers: see docs/fuzzing.md. All files are built in a temporary directory,
# which is removed at the end unless a target failed.
#
#   PYTHON=/path/to/python tests/fuzz/fuzz.sh SECONDS [vox|vxa|config ...]   fuzz the targets for SECONDS in all
#   PYTHON=/path/to/python tests/fuzz/fuzz.sh FILE vox|vxa|config            repeat a single input
#   PYTHON=/path/to/python tests/fuzz/fuzz.sh FOLDER [vox|vxa|config ...]    merge FOLDER/TARGET into corpus/
#
# SEED=0 selects a random seed. CORPUS=FOLDER keeps the inputs that increase coverage, in FOLDER/TARGET.
set -euo pipefail

usage="usage: fuzz.sh SECONDS|FILE|FOLDER [vox|vxa|config ...]"
given=${1:?$usage}
shift
targets=("$@")
[[ $# -gt 0 ]] || targets=(vox vxa config)
for target in "${targets[@]}"; do
    [[ $target =~ ^(vox|vxa|config)$ ]] || { echo "fuzz.sh: unknown target '$target'; $usage" >&2; exit 2; }
done
if [[ -e $given ]]; then
    given=$(realpath "$given")
elif [[ ! $given =~ ^[1-9][0-9]{0,5}$ ]]; then
    echo "fuzz.sh: '$given' is not a number of seconds (1 to 999999), a file or a folder; $usage" >&2
    exit 2
fi

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
python=${PYTHON:-python3}
place=$(mktemp -d)
found=$place/found # inputs that make a target fail
mkdir "$found"
trap 'rmdir "$found" 2>/dev/null && rm -rf "$place"' EXIT

# ---- tools ---------------------------------------------------------------------------------------------------------

has_libfuzzer() {
    printf '%s\n' '#include <stddef.h>' '#include <stdint.h>' \
        'int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) { return data && size > 9 ? 0 : 0; }' >"$place/probe.c"
    "$1" -fsanitize=fuzzer,address,undefined "$place/probe.c" -o "$place/probe" &>"$place/probe.log"
}

find_clang() {
    local candidate
    local candidates=(clang clang-{22..11})
    for candidate in "${CLANG:-${candidates[@]}}"; do
        if has_libfuzzer "$candidate"; then
            clang=$candidate
            return 0
        fi
    done
    return 1
}

install_clang() {
    [[ -z ${CLANG:-} && $(id -u) == 0 ]] && command -v apt-get >/dev/null || return 1
    echo "fuzz.sh: clang with libFuzzer is not installed; installing it with apt-get" >&2
    export DEBIAN_FRONTEND=noninteractive
    {
        apt-get update
        apt-get install --yes --no-install-recommends clang libclang-rt-dev ||
            apt-get install --yes --no-install-recommends clang # older releases have a single package
    } &>"$place/apt.log" || { tail -n 5 "$place/apt.log" >&2; return 1; }
}

if ! find_clang && ! { install_clang && find_clang; }; then
    echo "fuzz.sh: ${CLANG:-clang} with libFuzzer and the sanitizers is required and not installed; install it" \
        "(Debian and Ubuntu: apt-get install clang libclang-rt-dev), or set CLANG to its path" >&2
    exit 1
fi
if ! "$python" -c 'import atheris' 2>"$place/atheris.log"; then
    tail -n 1 "$place/atheris.log" >&2
    echo "fuzz.sh: $python has no atheris; install it with: $python -m pip install 'atheris>=3,<4'" >&2
    exit 1
fi

# ---- building ------------------------------------------------------------------------------------------------------

sanitizers=(-fsanitize=address,undefined -fno-sanitize-recover=all)

build_vox() {
    local flags=(-std=c11 -g -O1 -fno-omit-frame-pointer -ffp-contract=off -Wall -Wextra -Wconversion -Wshadow)
    local source sources
    mkdir "$place/vox"
    mapfile -t sources < <(find "$root/libvox" -name '*.c' -not -path '*/evoframe_*')
    for source in "${sources[@]}"; do
        "$clang" "${flags[@]}" "${sanitizers[@]}" -fsanitize=fuzzer-no-link -I "$root/libvox/include" -I "$root/libvox" \
            -Dmalloc=fuzz_malloc -Dcalloc=fuzz_calloc -c "$source" -o "$place/vox/$(basename "$source" .c).o"
    done
    "$clang" "${flags[@]}" "${sanitizers[@]}" -fsanitize=fuzzer -I "$root/libvox/include" "$here/fuzz_vox.c" \
        "$place"/vox/*.o -o "$place/fuzz_vox" -lm
}

# The interpreter was built without the sanitizer, so the sanitizer's runtime must be loaded first. It is linked again
# without its own coverage collector, since atheris includes that of libFuzzer, and with libstdc++, since atheris
# throws C++ exceptions.
build_runtime() {
    local archive name
    for name in "libclang_rt.asan-$(uname -m).a" libclang_rt.asan.a; do
        archive=$("$clang" -print-file-name="$name")
        [[ -e $archive ]] && break
    done
    mkdir "$place/runtime"
    (cd "$place/runtime" && ar x "$archive" && rm -f sanitizer_coverage_libcdep*.o asan_preinit*.o)
    printf '%s\n' 'void nothing(_Bool on, const char *where) __asm__("_ZN11__sanitizer18InitializeCoverageEbPKc");' \
        'void nothing(_Bool on, const char *where) { (void)on, (void)where; }' |
        "$clang" -fPIC -x c -c - -o "$place/runtime/nothing.o"
    "$clang" -shared "$place"/runtime/*.o -o "$place/asan.so" -Wl,-z,defs,--no-as-needed -lstdc++ -lpthread -ldl -lm -lrt
}

build_extension() {
    CC=$clang LDSHARED="$clang -shared" EVOFRAME_SANITIZE=1 "$python" -c '
import runpy, sys
runpy.run_path(sys.argv[1] + "/extensions.py")["libvox"].compile(tmpdir=sys.argv[2])
' "$root" "$place" &>"$place/extension.log" || { cat "$place/extension.log" >&2; return 1; }
    cp "$root"/libvox/evoframe_libvox/*.py "$place/evoframe_libvox/"
}

# ---- running -------------------------------------------------------------------------------------------------------

# Runs a target with options of libFuzzer.
start() {
    local target=$1
    shift
    local options=(-timeout=30 -rss_limit_mb=2048 -artifact_prefix="$found/$target-")
    if [[ $target == vox ]]; then
        "$place/fuzz_vox" "${options[@]}" -max_len=256 "$@"
        return
    fi
    # Python itself leaks, so leaks are not detected. Every allocation stores a stack, so stacks are short.
    TMPDIR=$place PYTHONPATH=$place PYTHONDONTWRITEBYTECODE=1 LD_PRELOAD=$place/asan.so \
        ASAN_OPTIONS=detect_leaks=0:quarantine_size_mb=32:malloc_context_size=8 UBSAN_OPTIONS=print_stacktrace=1 \
        "$python" "$here/fuzz_$target.py" "${options[@]}" -max_len=20000 -dict="$here/$target.dict" "$@"
}

hunt() {
    local target=$1 seconds=$2
    local log=$place/$target.log corpus=${CORPUS:-$place/corpus}/$target
    mkdir -p "$corpus"
    if start "$target" -seed="${SEED:-1}" -max_total_time="$seconds" "$corpus" "$here/corpus/$target" &>"$log"; then
        echo "$target: $(grep -E '^#[0-9]+\s+DONE' "$log" | tr -s '\t ' ' ')"
        return 0
    fi
    tail -n 100 "$log" >&2
    cp "$log" "$found/$target.log"
    echo "fuzz.sh: $target failed: $(ls -d "$found/$target"* | tr '\n' ' ')" >&2
    echo "fuzz.sh: to repeat an input: PYTHON=$python $here/fuzz.sh FILE $target" >&2
    return 1
}

# Reduces the corpus to the smallest inputs that cover every branch covered by the folder and the corpus.
merge() {
    local target=$1 from=$2 corpus=$here/corpus/$target
    mkdir "$place/merged"
    start "$target" -set_cover_merge=1 -use_counters=0 "$place/merged" "$corpus" "$from/$target" &>"$place/merge.log" ||
        { tail -n 20 "$place/merge.log" >&2; return 1; }
    [[ -n $(ls "$place/merged") ]] || { echo "fuzz.sh: no inputs were merged; the corpus is unchanged" >&2; return 1; }
    rm -rf "$corpus"
    mv "$place/merged" "$corpus"
    echo "$target: $(find "$corpus" -type f | wc -l) inputs, $(cat "$corpus"/* | wc -c) bytes"
}

[[ " ${targets[*]} " != *" vox "* ]] || build_vox
[[ ${targets[*]} == vox ]] || { build_runtime && build_extension; }
status=0
for target in "${targets[@]}"; do
    if [[ -f $given ]]; then
        start "$target" "$given" || status=1
    elif [[ -d $given ]]; then
        merge "$target" "$given"
    else
        hunt "$target" $(((given + ${#targets[@]} - 1) / ${#targets[@]})) || status=1
    fi
done
exit $status
