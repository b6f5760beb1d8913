#!/usr/bin/env bash
# npm's @sparticuz/chromium: ANGLE's libraries in its bundle of SwiftShader.
#
# Expected: the newest version has the newest ANGLE, so a program that wants an OpenGL ES library takes 153.0.0.
# Seen: 147.0.2 has a whole libGLESv2.so (some megabytes, which draws). That of 153.0.0 still bears the name and is a stub
#       of some hundred kilobytes. A version that draws must be pinned by what it holds.
# Needs npm and node (for its Brotli). Fails where that changes.
set -euo pipefail
dir="$(mktemp -d)"
trap 'rm -rf "$dir"' EXIT
cd "$dir"
size() {
    mkdir -p "$1"
    npm pack --silent --pack-destination "$1" "@sparticuz/chromium@$1" >/dev/null
    tar -xzf "$1"/*.tgz -C "$1"
    node -e 'const z = require("zlib"), f = require("fs");
        f.writeFileSync(process.argv[2], z.brotliDecompressSync(f.readFileSync(process.argv[1])))' \
        "$1/package/bin/swiftshader.tar.br" "$1/bundle.tar"
    mkdir -p "$1/bundle"
    tar -xf "$1/bundle.tar" -C "$1/bundle"
    stat -c %s "$(find "$1/bundle" -name libGLESv2.so)"
}
whole="$(size 147.0.2)"
stub="$(size 153.0.0)"
echo "libGLESv2.so: $whole bytes in 147.0.2, $stub bytes in 153.0.0"
if [ "$whole" -gt 5000000 ] && [ "$stub" -lt 1000000 ]; then
    echo "sparticuz-chromium-angle: as seen"
else
    echo "sparticuz-chromium-angle: no longer so" >&2
    exit 1
fi
