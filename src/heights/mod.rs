//! Height maps: read from files, written to files, resampled, and made of noise.
//!
//! A [`HeightMap`] is a rectangle of heights in metres. Its rows run from south to north and each row from west to
//! east, as the cells of [`crate::terrain`] do. A height that is not known is NaN, which the terrain turns into a hole.
//!
//! | file | numbers | first row | further contents |
//! |---|---|---|---|
//! | raw | 16-bit whole numbers or 32-bit floats, in either byte order | by [`RawHeights`] | nothing |
//! | PNG, one channel of grey | 8 or 16 bits | north | pixels without height, by transparency |
//! | Terragen `.ter` (Planetside 2003, *Terrain file specification*) | 16 bits with a scale and a base | south | distance of samples |
//! | ESRI ASCII grid (Esri, *Esri ASCII raster format*) | text | north | distance and place of samples, the number for no data |
//!
//! A height is `base + step x number` ([`HeightScale`]), so whole numbers keep their full precision, and feet become
//! metres. The caller names the number that means no data; NaN always does. For a damaged file every reader returns an
//! error that names the file or its format, the place in it and what is accepted. Other formats must be converted
//! first, by `gdal_translate`, which writes each of these formats; `docs/heights.md` has the commands.
//!
//! [`HeightMap::resampled`] keeps the mean height. It averages, over each new cell, the piecewise parabolas of Colella
//! and Woodward (1984, *The Piecewise Parabolic Method*, equations 1.5 to 1.9), whose mean in each old cell is the
//! height there. [`NoiseTerrain`] is fractional Brownian motion or ridges, a pure function of place and seed.
//!
//! ```
//! use welkin::heights::{HeightMap, HeightScale, HeightSettings};
//!
//! # fn main() -> welkin::Result<()> {
//! // Feet in a text, the northern row first; a file is read by HeightMap::load.
//! let text = b"ncols 3 nrows 2 cellsize 90 nodata_value -9999  1000 1010 1030  990 -9999 1005";
//! let feet = HeightScale { step_m: 0.3048, base_m: 0.0 };
//! let map = HeightMap::from_bytes(text, &HeightSettings { scale: feet, ..Default::default() })?;
//! assert_eq!(map.height_m(0, 1), Some(304.8));
//! assert_eq!(map.height_m(1, 0), None);
//!
//! // 16 bits in as fine steps as the heights allow; 0 means no data.
//! let settings = HeightSettings { scale: HeightScale::fitting(&map), no_data: Some(0.0), ..Default::default() };
//! let png = map.to_png(&settings)?;
//! assert_eq!(HeightMap::from_bytes(&png, &settings)?.missing(), 1);
//! # Ok(())
//! # }
//! ```
//!
//! The room needs no GPU and has no state. Reading takes memory in proportion to the file, never to the size that a
//! header claims.

mod file;
mod map;
mod relief;
mod resample;
mod settings;
#[cfg(test)]
mod tests;

pub use map::{HeightMap, MAX_HEIGHT_SAMPLES};
pub use relief::{NoiseTerrain, ReliefKind};
pub use settings::{ByteOrder, HeightScale, HeightSettings, RawHeights, RawSample, RowOrder};
