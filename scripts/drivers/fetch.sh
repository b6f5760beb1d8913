# What the drivers of scripts/drivers.sh are fetched with: packages unpacked into folders, for their own loader to run.
# Nothing is installed, and nothing needs to be root. Each function prints why it failed and returns 1.

# Debian 13's: a stable suite keeps its version, where testing and unstable move on each day. DRIVERS_SUITE=sid looks ahead.
readonly SUITE="${DRIVERS_SUITE:-trixie}"
# The newest release that is known to carry ANGLE as a library of its own; 153 links it into the browser.
readonly ANGLE=@sparticuz/chromium@147.0.2

# Mirror of Debian in apt's own sources.
debian_mirror() {
    apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 2>/dev/null | grep -m1 '/debian/$' ||
        { echo "apt's sources name no mirror of Debian"; return 1; }
}

# fetch_debian SUITE FOLDER PACKAGE.. : the packages and all they depend on, unpacked to FOLDER/root. A folder that is
# complete is kept.
fetch_debian() {
    local suite="$1" folder="$2" mirror deb
    shift 2
    [ ! -f "$folder/complete" ] || return 0
    command -v apt-get >/dev/null && command -v dpkg-deb >/dev/null || { echo "no apt-get and dpkg-deb"; return 1; }
    local keys=/usr/share/keyrings/debian-archive-keyring.gpg
    [ -f "$keys" ] || { echo "no debian-archive-keyring"; return 1; }
    mirror="$(debian_mirror)" || { echo "$mirror"; return 1; }
    rm -rf "$folder"
    mkdir -p "$folder"/{etc,lists/partial,archives/partial,root}
    : >"$folder/status" # nothing is installed: every dependency is fetched
    echo "deb [signed-by=$keys] $mirror $suite main" >"$folder/etc/sources.list"
    local options=(
        -o Dir::State="$folder" -o Dir::State::status="$folder/status" -o Dir::State::Lists="$folder/lists"
        -o Dir::Cache="$folder" -o Dir::Cache::archives="$folder/archives" -o Dir::Etc="$folder/etc"
        -o APT::Install-Recommends=0 -o APT::Sandbox::User= -o Acquire::Languages=none -o Acquire::Retries=2
    )
    apt-get "${options[@]}" -qq update >"$folder/log" 2>&1 &&
        apt-get "${options[@]}" -qq -y --download-only install "$@" >>"$folder/log" 2>&1 ||
        { echo "packages of $suite cannot be had: $(grep -m1 '^E:' "$folder/log")"; return 1; }
    for deb in "$folder"/archives/*.deb; do
        dpkg-deb -x "$deb" "$folder/root" || { echo "$deb cannot be unpacked"; return 1; }
    done
    rm -rf "$folder/archives" "$folder/lists"
    touch "$folder/complete"
}

# fetch_angle PACKAGE@VERSION FOLDER : ANGLE's libEGL.so and libGLESv2.so with SwiftShader, from an npm package.
fetch_angle() {
    local package="$1" folder="$2"
    [ ! -f "$folder/complete" ] || return 0
    command -v npm >/dev/null && command -v node >/dev/null || { echo "no npm"; return 1; }
    rm -rf "$folder"
    mkdir -p "$folder"
    (cd "$folder" && npm pack --silent "$package" >log 2>&1 && tar -xzf ./*.tgz package/bin/swiftshader.tar.br) ||
        { echo "$package cannot be had from npm: $(tail -1 "$folder/log")"; return 1; }
    node -e 'process.stdout.write(require("zlib").brotliDecompressSync(require("fs").readFileSync(process.argv[1])))' \
        "$folder/package/bin/swiftshader.tar.br" | tar -xC "$folder" || { echo "$package cannot be unpacked"; return 1; }
    rm -rf "$folder"/*.tgz "$folder/package"
    [ -f "$folder/libGLESv2.so" ] && touch "$folder/complete"
}
