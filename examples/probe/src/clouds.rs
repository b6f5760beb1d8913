//! `probe slab`, `probe cover`: the drawn clouds.

use welkin::clouds::{
    cover::seen_over_seeds,
    probe::{EvenCloud, fluxes},
};
use welkin::{Error, Result, Status, gpu::Device, weather::CloudKind};

use crate::csv::Table;

/// Needs the columns `tau,g,mu0,albedo` in this order. Answers with `R,T`: the shares of the incident flux that a slab
/// reflects and transmits, direct and diffuse together.
///
/// # Errors
/// [`Status::Parse`] with line and column; GPU faults.
pub fn slabs(device: &Device, text: &str) -> Result<String> {
    const HEADER: &str = "tau,g,mu0,albedo";
    if text.lines().next().unwrap_or_default().trim() != HEADER {
        return Err(Error::new(Status::Parse, format!("line 1, column 1: the header must be `{HEADER}`")));
    }
    let mut out = format!("{HEADER},R,T\n");
    for row in Table::read(text, HEADER)?.rows {
        let fields = row.fields();
        if fields.len() != 4 {
            return Err(row.fault("four numbers are wanted"));
        }
        let mut numbers = [0.0; 4];
        for (number, field) in numbers.iter_mut().zip(&fields) {
            let text = field.text;
            *number = text.trim().parse().map_err(|_| field.fault(format!("`{text}` is no number")))?;
        }
        let [tau, asymmetry, cosine, albedo] = numbers;
        let cloud = EvenCloud { depths: [f64::INFINITY, f64::INFINITY, tau], asymmetry, albedo, cosine };
        let flux = fluxes(device, &cloud).map_err(|e| row.fault(e))?;
        out.push_str(&format!("{},{:.6},{:.6}\n", row.line.trim(), flux[5], flux[4]));
    }
    Ok(out)
}

/// Number of viewpoints for each seed's sky.
const PLACES: usize = 64;

/// Returns the kind of cloud with this name.
///
/// # Errors
/// [`Status::Parse`] for an unknown genus.
pub fn kind_of(genus: &str) -> Result<CloudKind> {
    let known = || CloudKind::ALL.iter().filter(|k| **k != CloudKind::Unknown);
    known().find(|k| k.name() == genus).copied().ok_or_else(|| {
        let names: Vec<&str> = known().map(|k| k.name()).collect();
        Error::new(Status::Parse, format!("`{genus}` is no genus; there are {}", names.join(", ")))
    })
}

/// Answers with `mean,spread` over seeds of the visible cover of a genus, when its cover is set to `cover`.
///
/// # Errors
/// [`Status::Parse`] for an unknown genus.
pub fn cover(genus: &str, cover: f64, seeds: u64) -> Result<String> {
    let [mean, spread] = seen_over_seeds(kind_of(genus)?, cover, seeds, PLACES)?;
    Ok(format!("mean,spread\n{mean:.6},{spread:.6}\n"))
}
