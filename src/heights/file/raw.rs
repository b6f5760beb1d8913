//! Raw files, which hold only numbers.

use super::{
    super::{
        map::{HeightMap, room_for},
        settings::{ByteOrder, HeightSettings, RawHeights, RawSample},
    },
    numbers::{check_free, in_order, whole_number},
    samples::Samples,
};
use crate::error::{Error, Result, Status};

pub fn read(bytes: &[u8], raw: &RawHeights, settings: &HeightSettings) -> Result<HeightMap> {
    let size = raw.sample.bytes();
    let needed = u64::from(raw.columns) * u64::from(raw.rows) * size as u64;
    if needed != bytes.len() as u64 {
        return Err(Error::new(
            Status::Parse,
            format!(
                "byte {}: {} x {} numbers of {size} bytes end at byte {needed}, the file ends at byte {}; settings.raw \
                 must have the size of the file",
                needed.min(bytes.len() as u64),
                raw.columns,
                raw.rows,
                bytes.len()
            ),
        ));
    }
    let mut samples = Samples::new(raw.columns, raw.rows, settings)?;
    for (i, number) in bytes.chunks_exact(size).enumerate() {
        samples.take(number_of(number, raw), format_args!("byte {}", i * size))?;
    }
    Ok(samples.finish(raw.row_order))
}

/// Returns the number in `bytes`, which have the length of the file's kind of number.
fn number_of(bytes: &[u8], raw: &RawHeights) -> f64 {
    let mut four = [0; 4];
    let size = bytes.len().min(4);
    four[..size].copy_from_slice(&bytes[..size]);
    if raw.byte_order == ByteOrder::Big {
        four[..size].reverse();
    }
    match raw.sample {
        RawSample::U16 => f64::from(u16::from_le_bytes([four[0], four[1]])),
        RawSample::I16 => f64::from(i16::from_le_bytes([four[0], four[1]])),
        RawSample::F32 => f64::from(f32::from_le_bytes(four)),
    }
}

pub fn write(map: &HeightMap, settings: &HeightSettings) -> Result<Vec<u8>> {
    let Some(raw) = settings.raw else {
        return Err(Error::invalid("settings.raw", "must be set to the layout of the file"));
    };
    if [raw.columns, raw.rows] != [map.columns(), map.rows()] {
        let accepted = format!("the map's {} with rows = {}", map.columns(), map.rows());
        let got = format!("{} x {}", raw.columns, raw.rows);
        return Err(Error::range("settings.raw.columns", &accepted, got));
    }
    let size = raw.sample.bytes();
    let mut file = room_for((size * map.heights_m().len()) as u64)?;
    for index in in_order(map, raw.row_order) {
        let number = match raw.sample {
            RawSample::U16 => whole_number(map, index, settings, [0, 65_535])? as u32,
            RawSample::I16 => whole_number(map, index, settings, [-32_768, 32_767])? as u32,
            RawSample::F32 => float(map, index, settings)?.to_bits(),
        };
        let mut bytes = number.to_le_bytes();
        if raw.byte_order == ByteOrder::Big {
            bytes[..size].reverse();
        }
        file.extend_from_slice(&bytes[..size]);
    }
    Ok(file)
}

/// Returns the float that is written for a height.
fn float(map: &HeightMap, index: usize, settings: &HeightSettings) -> Result<f32> {
    let (height, scale) = (f64::from(map.heights_m()[index]), settings.scale);
    if height.is_nan() {
        return Ok(settings.no_data.map_or(f32::NAN, |none| none as f32));
    }
    let number = (height - scale.base_m) / scale.step_m;
    check_free(index, number, settings)?;
    Ok(number as f32)
}
