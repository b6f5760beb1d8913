# What every script does with its command line; sourced, not run. A script's own text is the comment at its top.

# Answers --help and --version, wherever they stand, on standard output and ends with status 0.
answer_command_line() {
    local word script="${BASH_SOURCE[1]}" root
    for word in "$@"; do
        case "$word" in
        --help | -h)
            sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$script"
            exit 0
            ;;
        --version)
            root="$(dirname "${BASH_SOURCE[0]}")/.."
            echo "$(basename "$script") (Welkin $(sed -n '/^\[workspace\.package\]/,/^\[/s/^version = "\(.*\)"/\1/p' "$root/Cargo.toml"))"
            exit 0
            ;;
        esac
    done
}

# Names an argument that the script does not take and ends with status 2.
refuse() {
    local name kind="unexpected argument"
    name="$(basename "${BASH_SOURCE[1]}")"
    [ "${1#-}" = "$1" ] || kind="unknown option"
    echo "$name: $kind $1; $name --help says what it takes" >&2
    exit 2
}
