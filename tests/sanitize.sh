#!/usr/bin/env bash
# Runs the tests of the C libraries with the address and undefined-behavior sanitizers, and a C program for each
# library also with the leak sanitizer (Python itself leaks). All files are built in a temporary directory, which is
# removed at the end.
#
#   PYTHON=/path/to/python tests/sanitize.sh [pytest options]
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
python=${PYTHON:-python3}
compiler=${CC:-cc}
libraries=(libcppn libvox)
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT

# Some compilers come without the libraries of the sanitizers; the commands below would fail without naming the cause.
if ! echo 'int main(void) { return 0; }' | "$compiler" -fsanitize=address,undefined -x c - -o "$place/probe" ||
    [[ ! -e $("$compiler" -print-file-name=libasan.so) ]]; then
    echo "sanitize.sh: $compiler has no libasan or libubsan; install them, or set CC to a compiler with both" >&2
    exit 1
fi

flags=(-std=c11 -g -O1 -Wall -Wextra -Wconversion -Wshadow -Werror -fsanitize=address,undefined -fno-sanitize-recover=all)
for library in "${libraries[@]}"; do
    mapfile -t sources < <(find "$root/$library" -name '*.c' -not -path '*/evoframe_*')
    includes=(-I "$root/$library/include" -I "$root/$library")
    "$compiler" "${flags[@]}" "${includes[@]}" "$root/tests/$library/embed.c" "${sources[@]}" -o "$place/embed" -lm
    "$place/embed"
    EVOFRAME_SANITIZE=1 "$python" - "$root" "$library" "$place" <<'END'
import runpy
import sys

root, library, place = sys.argv[1:]
runpy.run_path(f"{root}/extensions.py")[library].compile(tmpdir=place)
END
    cp "$root/$library/evoframe_$library"/*.py "$place/evoframe_$library/"
done

# The interpreter was built without the sanitizer, so the sanitizer's runtime must be loaded first.
export LD_PRELOAD=$("$compiler" -print-file-name=libasan.so)
export ASAN_OPTIONS=detect_leaks=0 UBSAN_OPTIONS=print_stacktrace=1
export PYTHONMALLOC=malloc # so that the sanitizer checks the buffers of NumPy and cffi
export PYTHONPATH=$place PYTHONDONTWRITEBYTECODE=1
cd "$root"
for library in "${libraries[@]}"; do
    found=$("$python" -c "import evoframe_$library as built; print(built.__file__)")
    [[ $found == "$place"/* ]] || { echo "expected the sanitized build in $place, found $found" >&2; exit 1; }
done
# Captures only the output of Python: reports of sanitizers must reach the terminal.
"$python" -m pytest --numprocesses auto --capture=sys -p no:cacheprovider "${libraries[@]/#/tests/}" "$@"
