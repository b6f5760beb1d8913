#!/usr/bin/env bash
# Debian 12's qt6-base-dev 6.4.2: a program with a QOpenGLWidget, linked by pkg-config.
#
# Expected: qt6-base-dev has Qt6OpenGLWidgets.pc, so it has all that this file asks the linker for.
# Seen: the file requires Qt6OpenGL, for which pkg-config answers -lQt6OpenGL; that library's link is in another package,
#       libqt6opengl6-dev, which qt6-base-dev does not depend on, and linking fails until that is installed too.
# Needs Debian 12's package lists (apt-get update) and pkg-config; unpacks, installs nothing. Fails where that changes.
set -euo pipefail
dir="$(mktemp -d)"
trap 'rm -rf "$dir"' EXIT
cd "$dir"
version="6.4.2+dfsg-10"
apt-get download "qt6-base-dev=$version" "libqt6opengl6-dev=$version" >/dev/null
for package in qt6-base-dev libqt6opengl6-dev; do
    dpkg-deb -x "$package"_*.deb "$package"
done
pc="$(find qt6-base-dev -name Qt6OpenGLWidgets.pc)"
asked="$(PKG_CONFIG_LIBDIR="$(dirname "$pc")" pkg-config --libs Qt6OpenGLWidgets)"
here="$(find qt6-base-dev -name libQt6OpenGL.so | wc -l)"
there="$(find libqt6opengl6-dev -name libQt6OpenGL.so | wc -l)"
depends="$(dpkg-deb -f qt6-base-dev_*.deb Depends | grep -c libqt6opengl6-dev || true)"
echo "asked: $asked"
echo "libQt6OpenGL.so in qt6-base-dev: $here, in libqt6opengl6-dev: $there; dependency on it: $depends"
case "$asked" in *"-lQt6OpenGL "* | *-lQt6OpenGL) ;; *) asked="" ;; esac
if [ -n "$asked" ] && [ "$here $there $depends" = "0 1 0" ]; then
    echo "qt6-opengl-widgets-link: as seen"
else
    echo "qt6-opengl-widgets-link: no longer so" >&2
    exit 1
fi
