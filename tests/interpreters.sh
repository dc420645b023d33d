#!/usr/bin/env bash
# Runs the tests with each other installed version of CPython that the project supports. A wheel is built once and
# installed in a new environment for each version. For versions that are not installed, ruff and mypy check the code.
# All files are built in a temporary directory, which is removed at the end.
#
#   PYTHON=/path/to/python tests/interpreters.sh [pytest options]
#
# PYTHON is an interpreter with the project's development tools. VERSIONS="3.12 3.13" selects versions.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
python=$(realpath --no-symlinks "$(command -v "${PYTHON:-python3}")")
tools=$(dirname "$python")
read -r -a versions <<<"${VERSIONS:-3.11 3.12 3.13 3.14}"
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cd "$root"

# Prints the full version of an interpreter; fails if it is not CPython $2.
full_version() {
    "$1" -c 'import platform, sys
if platform.python_implementation() != "CPython" or not platform.python_version().startswith(sys.argv[1] + "."):
    sys.exit(1)
print(platform.python_version())' "$2" 2>/dev/null
}

# Also searches the interpreters of pyenv, which are not on the path.
find_interpreter() {
    local candidate
    local candidates=("python$1")
    if command -v pyenv >/dev/null; then
        candidates+=("$(pyenv root)/versions/$1".*/bin/python)
    fi
    for candidate in "${candidates[@]}"; do
        if full_version "$candidate" "$1" >/dev/null; then
            command -v "$candidate"
            return 0
        fi
    done
    return 1
}

uv() {
    "$tools/uv" --quiet "$@"
}

# Selects errors only: style rules for newer versions do not apply until the project requires such a version.
check_version() {
    echo "== Python $1: not installed; running ruff and mypy =="
    "$tools/ruff" check --select E9,F,PLE --target-version "py${1/./}" || return 1
    "$tools/mypy" --python-version "$1" || return 1
}

run_tests() {
    local version=$1 interpreter=$2 place_of=$place/$1
    shift 2
    echo "== Python $("$interpreter" -c 'import platform; print(platform.python_version())') =="
    uv venv --python "$interpreter" "$place_of" || return 1
    uv pip install --python "$place_of" "${wheel[0]}[report,testing]" --group "$root/pyproject.toml:tests" || return 1
    "$place_of/bin/python" -m pytest -p no:cacheprovider "$@" || return 1
}

own=$("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])')
uv build --python "$python" --out-dir "$place/dist"
wheel=("$place"/dist/*.whl)
passed=() missing=() failed=()
for version in "${versions[@]}"; do
    [[ $version != "$own" ]] || continue
    if interpreter=$(find_interpreter "$version"); then
        if run_tests "$version" "$interpreter" "$@"; then passed+=("$version"); else failed+=("$version"); fi
    else
        missing+=("$version")
        check_version "$version" || failed+=("$version, ruff or mypy")
    fi
done

echo "passed: ${passed[*]:-none}; not installed, checked with ruff and mypy only: ${missing[*]:-none}"
[[ ${#failed[@]} == 0 ]] || { printf 'interpreters.sh: failed: %s\n' "${failed[@]}" >&2; exit 1; }
