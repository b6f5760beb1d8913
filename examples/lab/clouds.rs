//! Thresholds of the clouds' map, found by looking at skies of other seeds than the tests'.

use welkin::{
    Result,
    clouds::{
        cover,
        field::{Map, Solid},
    },
    weather::CloudKind,
};

/// Seeds over which thresholds are found, and places from which each is looked at.
const SEEDS: std::ops::Range<u64> = 100..106;
const PLACES: usize = 48;

/// Prints `src/clouds/thresholds.in`.
pub fn print_thresholds() -> Result<()> {
    let seeds = SEEDS.map(|seed| Ok((Map::new(seed), Solid::new(seed)?))).collect::<Result<Vec<_>>>()?;
    println!("[");
    for kind in CloudKind::ALL.iter().filter(|kind| **kind != CloudKind::Unknown) {
        println!("    (CloudKind::{kind:?}, {:.3?}),", cover::find_thresholds(*kind, &seeds, PLACES)?);
    }
    println!("]");
    Ok(())
}
