#!/usr/bin/env bash
# Crate metar 0.9.3: the heights of clouds.
#
# Expected: CloudLayer::height is in feet, as its documentation says, so that BKN040 is 4000.
# Seen: it is the report's figure as it stands, 40, in hundreds of feet; a layer whose height was not measured
#       (BKN///) is answered with no height, and a sky that was not seen (//////) counts as a layer too.
# Fails where that changes.
set -euo pipefail
dir="$(mktemp -d)"
trap 'rm -rf "$dir"' EXIT
mkdir -p "$dir/src"
cat > "$dir/Cargo.toml" <<'TOML'
[package]
name = "finding"
version = "0.0.0"
edition = "2021"

[dependencies]
metar = "=0.9.3"
TOML
cat > "$dir/src/main.rs" <<'RS'
fn main() {
    for report in [
        "EGLL 041620Z 24010KT 9999 BKN040 12/08 Q1013",
        "EGLL 041620Z 24010KT 9999 BKN/// 12/08 Q1013",
        "EGLL 041620Z 24010KT 9999 ////// 12/08 Q1013",
    ] {
        let read = metar::Metar::parse(report).expect("a report of the standard's form");
        println!("{} layers: {:?}", read.cloud_layers.len(), read.cloud_layers);
    }
}
RS
cd "$dir"
cargo run --quiet 2>"$dir/log" | tee "$dir/said" || { cat "$dir/log" >&2; exit 1; }
diff - "$dir/said" <<'SEEN' || { echo "metar-cloud-heights: no longer so" >&2; exit 1; }
1 layers: [CloudLayer { density: Known(Broken), kind: Known(Normal), height: Known(40) }]
1 layers: [CloudLayer { density: Known(Broken), kind: Known(Normal), height: Unknown }]
1 layers: [CloudLayer { density: Unknown, kind: Known(Normal), height: Unknown }]
SEEN
echo "metar-cloud-heights: as seen"
