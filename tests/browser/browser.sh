#!/usr/bin/env bash
# Opens the page of reports in a browser without a screen. Installs Chromium where that is missing and can be installed.
#
#   PYTHON=/path/to/python tests/browser/browser.sh [pytest's arguments ...]
#
# CHROMIUM=/path/to/chromium chooses one that is there.
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
    echo "browser.sh: no Chromium is here; apt-get installs one" >&2
    local log
    log=$(mktemp)
    export DEBIAN_FRONTEND=noninteractive
    { apt-get update && apt-get install --yes chromium; } &>"$log" ||
        { tail -n 5 "$log" >&2; return 1; }
    rm "$log"
}

if ! find_chromium && ! { install_chromium && find_chromium; }; then
    echo "browser.sh: Chromium is needed and is not here; install it (Debian and Ubuntu: apt-get install chromium)," \
        "or set CHROMIUM to one" >&2
    exit 1
fi
export CHROMIUM
exec "${PYTHON:-python3}" -m pytest -m browser "$here" "$@"
