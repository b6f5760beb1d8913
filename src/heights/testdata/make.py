"""Makes the files beside this script by GDAL, and writes to readings.txt how GDAL reads each of them, row by row from
the north. Run from any folder by a Python with rasterio (this was 1.4.4, GDAL 3.10.3):

    python src/heights/testdata/make.py
"""

from pathlib import Path

import numpy
import rasterio
from rasterio.transform import from_origin

here = Path(__file__).parent
dem = here / "../../../examples/data/jacksboro_dem.png"
with rasterio.open(dem) as source:
    metres = source.read(1)[100:105, 200:207]
rows, columns = metres.shape
size = dict(count=1, width=columns, height=rows, transform=from_origin(1000, 5000, 90, 90))
readings = []


def write(name, values, driver, **more):
    with rasterio.open(here / name, "w", driver=driver, dtype=values.dtype, **size, **more) as made:
        made.write(values, 1)


def keep_reading(name):
    with rasterio.open(here / name) as made:
        band = made.read(1, masked=True).astype("float64") * made.scales[0] + made.offsets[0]
    numbers = " ".join("none" if v is numpy.ma.masked or numpy.isnan(v) else repr(float(v)) for v in band.flat)
    readings.append(f"{name} {columns} {rows} {numbers}\n")


def keep(name, values, driver, **more):
    write(name, values, driver, **more)
    keep_reading(name)


with_hole = metres.astype("float32") * numpy.float32(0.3048)
with_hole[2, 3] = -9999
keep("grid.asc", with_hole, "AAIGrid", nodata=-9999)
grey = metres.astype("uint16")
keep("grey16.png", grey, "PNG")
hole = grey.copy()
hole[1, 5] = 65535
keep("hole16.png", hole, "PNG", nodata=65535)
keep("grey8.png", (metres // 5).astype("uint8"), "PNG")

# ENVI files are raw numbers with their layout in a text beside them, which tells GDAL the order of bytes.
signed = metres.astype("int16") - 900
for name, values in [("u16", grey), ("i16", signed), ("f32", with_hole)]:
    keep(f"{name}_little.raw", values, "ENVI", **(dict(nodata=-9999) if name == "f32" else {}))
    little, big = here / f"{name}_little.raw", here / f"{name}_big.raw"
    big.write_bytes(numpy.fromfile(little, values.dtype).byteswap().tobytes())
    header = little.with_suffix(".hdr").read_text().replace("byte order = 0", "byte order = 1")
    big.with_suffix(".hdr").write_text(header)
    keep_reading(big.name)

low, high = float(metres.min()), float(metres.max())
keep("terrain.ter", metres.astype("float32"), "Terragen", MINUSERPIXELVALUE=low, MAXUSERPIXELVALUE=high)

(here / "readings.txt").write_text("".join(readings))
for pattern in ["*.hdr", "*.aux.xml", "*.prj"]:
    [extra.unlink() for extra in here.glob(pattern)]
