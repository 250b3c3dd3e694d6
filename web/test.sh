#!/usr/bin/env bash
# Tests the page in a real browser: builds it and the command, makes recordings, and runs test/*.mjs.
#
# Status 77 where there is no node or no Chromium: nothing was tested then, and that is said.
set -euo pipefail
cd "$(dirname "$0")"

missing() {
    echo "the page was not tested: $1" >&2
    exit 77
}
command -v node >/dev/null && command -v npm >/dev/null || missing "node and npm are not here"
chromium=${CHROMIUM:-$(command -v chromium || true)}
if [ -z "$chromium" ]; then
    apt-get install -y --no-install-recommends chromium >/dev/null 2>&1 || missing "Chromium cannot be installed"
    chromium=$(command -v chromium) || missing "Chromium is not here"
fi
(cd test && npm ci --ignore-scripts --no-audit --no-fund >/dev/null 2>&1) || missing "playwright-core cannot be installed"

./build.sh
cargo build --locked --release --manifest-path ../Cargo.toml
built=$(cargo metadata --locked --format-version 1 --no-deps --manifest-path ../Cargo.toml |
    sed 's/.*"target_directory":"\([^"]*\)".*/\1/')
cargo test --locked -p bounce-audio-web -p xtask
CHROMIUM=$chromium BOUNCE_AUDIO=$built/release/bounce-audio node --test --test-concurrency=1 test/*.test.mjs
