//! Finds the thresholds of the cloud map from skies whose seeds differ from the tests', and compares the clouds' light
//! with photons.

use welkin::{
    Result,
    clouds::{
        cover,
        field::{Map, Solid},
        traced::CASES,
    },
    weather::CloudKind,
};

/// Seeds from which thresholds are found, and the number of viewpoints for each.
const SEEDS: std::ops::Range<u64> = 100..106;
const PLACES: usize = 48;

/// Prints `src/clouds/field/thresholds.in`.
pub fn print_thresholds() -> Result<()> {
    let seeds = SEEDS.map(|seed| Ok((Map::new(seed), Solid::new(seed)?))).collect::<Result<Vec<_>>>()?;
    println!("[");
    for kind in CloudKind::ALL.iter().filter(|kind| **kind != CloudKind::Unknown) {
        println!("    (CloudKind::{kind:?}, {:.3?}),", cover::find_thresholds(*kind, &seeds, PLACES)?);
    }
    println!("]");
    Ok(())
}

/// Number of rays compared per sky, and of photons per ray: in a quick run, and in a full one.
const RAYS: [usize; 2] = [20, 100];
const PHOTONS: [u32; 2] = [500, 4000];

/// Prints the difference between the clouds' light and that of photons traced through the same field.
///
/// # Errors
/// As [`Solid::new`].
pub fn print_photons(quick: bool) -> Result<()> {
    let which = usize::from(!quick);
    println!("per cent of the radiance; {} rays of each sky, {} photons along each", RAYS[which], PHOTONS[which]);
    for case in &CASES {
        let c = case.compare(RAYS[which], PHOTONS[which])?;
        let [sun, above, below] = c.parts.map(|p| 1e2 * p);
        let [one, mean] = c.chance.map(|p| 1e2 * p);
        let [both, depth, angle] = c.steps.map(|p| 1e2 * p);
        println!(
            "{}: off by {:.1} in the median, {:.1} at 95 %, {:+.1} in the mean (sun {sun:+.1}, sky {above:+.1}, ground {below:+.1}); \
             chance {one:.1} a ray, {mean:.1} in the mean; at 95 % {both:.2} from 64 times the steps, {depth:.2} by depth, {angle:.2} by angle",
            case.name,
            1e2 * c.p50,
            1e2 * c.p95,
            1e2 * c.bias
        );
    }
    Ok(())
}
