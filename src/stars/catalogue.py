"""Packs the Bright Star Catalogue as a CSV (hr, right_ascension_deg, declination_deg, visual_magnitude, temperature_k, name) into
catalogue.bin: python3 catalogue.py bright_stars.csv catalogue.bin. catalogue.rs says how it is laid out.
Stars without a spectral class are taken as white, 6500 K."""
import csv
import struct
import sys

rows = {}
with open(sys.argv[1], newline="") as f:
    for row in csv.DictReader(line for line in f if not line.startswith("#")):
        place = [round(float(row[k]) * 1e5) for k in ("right_ascension_deg", "declination_deg")]
        rows[int(row["hr"])] = (*place, round(float(row["visual_magnitude"]) * 100), int(row["temperature_k"] or 6500))
with open(sys.argv[2], "wb") as f:
    for hr in range(1, max(rows) + 1):
        f.write(struct.pack("<IihH", *rows.get(hr, (0, 0, 0, 0))))
