# Sourced by the scripts of tests that need a program which pip cannot install.

# require PROGRAM PACKAGE...: install packages with apt-get unless PROGRAM is found; fail by name if it cannot.
require() {
    local program=$1
    shift
    command -v "$program" >/dev/null && return
    if [[ $(id -u) == 0 ]] && command -v apt-get >/dev/null; then
        echo "$program is not installed; installing $* with apt-get" >&2
        local log
        log=$(mktemp)
        { apt-get update && DEBIAN_FRONTEND=noninteractive apt-get install --yes --no-install-recommends "$@"; } \
            &>"$log" || tail -n 5 "$log" >&2
        rm "$log"
        command -v "$program" >/dev/null && return
    fi
    echo "$program is required and not installed; install it (Debian and Ubuntu: apt-get install $*)" >&2
    return 1
}
