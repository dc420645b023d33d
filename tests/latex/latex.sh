#!/usr/bin/env bash
# Typesets tables of reports with pdflatex. Installs TeX Live if it is missing and apt-get can install it.
#
#   PYTHON=/path/to/python tests/latex/latex.sh [pytest options]
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source "$here/../support/require.sh"

require pdflatex texlive-latex-recommended
exec "${PYTHON:-python3}" -m pytest -m latex "$here" "$@"
