#!/usr/bin/env bash
# Builds the page into web/dist: files to be served, and bounce-audio.html, which is all of them in one and needs no server.
# A fresh machine needs rustup, or Debian's compiler for the web (rustc-web cargo-web rust-web-src lld).
set -euo pipefail
cd "$(dirname "$0")"

target=wasm32-unknown-unknown
has_target() { [ -d "$(rustc --print sysroot)/lib/rustlib/$target" ]; }
if has_target || rustup target add "$target" 2>/dev/null; then
    cargo build --locked --profile page --target "$target" -p bounce-audio-web
else
    # The distribution's compiler comes without that target's library, but with its source.
    linker=$(ls /usr/bin/wasm-ld-* 2>/dev/null | sort -V | tail -n 1)
    if [ -z "$linker" ]; then
        echo "no $target by rustup, and no wasm-ld: apt-get install rustc-web cargo-web rust-web-src lld" >&2
        exit 1
    fi
    PATH=/usr/bin:/bin RUSTC_BOOTSTRAP=1 CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER=$linker \
        cargo build --locked --profile page --target "$target" -p bounce-audio-web -Z build-std=std,panic_abort
fi
cargo build --locked --release -p xtask
built=$(cargo metadata --locked --format-version 1 --no-deps | sed 's/.*"target_directory":"\([^"]*\)".*/\1/')
"$built/release/xtask" "$built/$target/page/bounce_audio_web.wasm" page dist
gzipped=$(cat dist/{index.html,style.css,app.js,worker.js,recorder.js,library.wasm} | gzip -9 | wc -c)
echo "web/dist: $((gzipped / 1000)) kB gzipped; web/dist/bounce-audio.html: $(($(wc -c <dist/bounce-audio.html) / 1000)) kB"
