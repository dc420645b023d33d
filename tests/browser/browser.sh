#!/usr/bin/env bash
# Tests the page of reports in a headless browser. Installs Chromium if it is missing and can be installed.
#
#   PYTHON=/path/to/python tests/browser/browser.sh [pytest's arguments ...]
#
# CHROMIUM=/path/to/chromium selects an installed one.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

find_chromium() {
    local candidate
    for candidate in "${CHROMIUM:-chromium}" chromium-browser google-chrome; do
        CHROMIUM=$(command -v "$candidate") && return 0
    done
    return 1
}

install_chromium() {
    [[ $(id -u) == 0 ]] && command -v apt-get >/dev/null || return 1
    echo "browser.sh: Chromium not found; installing it with apt-get" >&2
    local log
    log=$(mktemp)
    export DEBIAN_FRONTEND=noninteractive
    { apt-get update && apt-get install --yes chromium; } &>"$log" ||
        { tail -n 5 "$log" >&2; return 1; }
    rm "$log"
}

if ! find_chromium && ! { install_chromium && find_chromium; }; then
    echo "browser.sh: Chromium not found; install it (Debian and Ubuntu: apt-get install chromium)," \
        "or set CHROMIUM to its path" >&2
    exit 1
fi
export CHROMIUM
exec "${PYTHON:-python3}" -m pytest -m browser "$here" "$@"
