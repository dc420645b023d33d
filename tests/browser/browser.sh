#!/usr/bin/env bash
# Tests the page of reports in headless Chromium. Installs Chromium if it is missing and apt-get can install it.
#
#   PYTHON=/path/to/python tests/browser/browser.sh [pytest options]
#
# CHROMIUM=/path/to/chromium selects an installed browser.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source "$here/../support/require.sh"

for candidate in "${CHROMIUM:-chromium}" chromium-browser google-chrome chromium; do
    CHROMIUM=$(command -v "$candidate") && break
done
[[ $CHROMIUM ]] || require chromium chromium
export CHROMIUM=${CHROMIUM:-$(command -v chromium)}
exec "${PYTHON:-python3}" -m pytest -m browser "$here" "$@"
