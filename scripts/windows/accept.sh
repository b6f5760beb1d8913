#!/usr/bin/env bash
# `make windows-accept`: the library's unit tests and those of the C functions, built for Windows and run under Wine.
# The closing line counts them: `windows: N passed, N failed`.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/../command_line.sh"
answer_command_line "$@"
[ $# = 0 ] || refuse "$1"
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
. scripts/windows/common.sh
. scripts/windows/setup.sh
. scripts/windows/wine.sh

# Runs a test program and adds what its closing line counts; one that ends without such a line counts as a failure.
run_tests() {
    local name="$1" log="$work/log/tests-$1.txt" counts
    mkdir -p "$work/log"
    cp "$2" "$programs/$name.exe"
    # From the root, where the tests look for what is committed.
    timeout 3000 "$wine" "$programs/$name.exe" --test-threads=2 >"$log" 2>&1 || true
    counts="$(tr -d '\r' <"$log" | sed -n 's/^test result: [a-zA-Z]*\. \([0-9]*\) passed; \([0-9]*\) failed; \([0-9]*\) ignored.*/\1 \2 \3/p')"
    if [ -z "$counts" ]; then
        failed=$((failed + 1))
        echo "  FAILED: $name ended without a result"
        tail -n 40 "$log" | sed 's/^/    | /'
        return
    fi
    read -r ok bad left <<<"$counts"
    passed=$((passed + ok)) failed=$((failed + bad)) skipped=$((skipped + left))
    echo "  $name: $ok passed, $bad failed, $left ignored"
    [ "$bad" = 0 ] || grep -a -A 12 -E '^---- .* stdout ----|^failures:' "$log" | head -n 200 | sed 's/^/    | /'
}

# No tables for a debugger, and no records for a second build: nothing here reads them.
export CARGO_PROFILE_DEV_DEBUG=0 CARGO_INCREMENTAL=0
install_packages
find_std
start_wine
cargo test --locked --lib --test abi_calls --target "$TARGET" "${std[@]}" --no-run --message-format=json >"$work/tests.json"
for name in welkin abi_calls; do
    # The programs of this build, by cargo's own word.
    program="$(sed -n "s/.*\"reason\":\"compiler-artifact\".*\"name\":\"$name\".*\"test\":true.*\"executable\":\"\([^\"]*\)\".*/\1/p" \
        "$work/tests.json" | tail -n 1)"
    [ -n "$program" ] || fail "cargo names no test program for $name"
    run_tests "$name" "$program"
done
summary windows
