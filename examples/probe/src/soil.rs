//! `probe soil-force`, `probe soil-wall`, `probe soil-sinkage`, `probe soil-heap`: the laws of soil, and heaps poured
//! by the rule of the stepped ground. Gravity is 9.81 m/s^2.

use welkin::{
    Result,
    soil::{
        heap_radii_m,
        laws::{CuttingInputs, SinkageSet, WallLaw, cutting_force},
    },
};

use crate::csv::{Column, Row, Table};

/// Needs the columns `rake_deg` (\[3, 145\]), `soil_metal_deg` and `phi_deg` (\[0, 65\]), `density_kg_m3` (\[1, 10
/// 000\]), `c_kpa` and `ca_kpa` (\[0, 10 000\]), `width_m` and `depth_m` (\[0, 100\]). Answers with the cutting force
/// of Reece and McKyes, `force_n`.
///
/// # Errors
/// [`welkin::Status::Parse`] with line and column for wrong input, and for angles at which no plane of failure exists.
pub fn forces(text: &str) -> Result<String> {
    let table = Table::read(text, "rake_deg,soil_metal_deg,phi_deg,density_kg_m3,c_kpa,ca_kpa,width_m,depth_m")?;
    let columns = [
        Column::new("rake_deg", [3.0, 145.0], "deg"),
        Column::new("soil_metal_deg", [0.0, 65.0], "deg"),
        Column::new("phi_deg", [0.0, 65.0], "deg"),
        Column::new("density_kg_m3", [1.0, 1e4], "kg/m^3"),
        Column::new("c_kpa", [0.0, 1e4], "kPa"),
        Column::new("ca_kpa", [0.0, 1e4], "kPa"),
        Column::new("width_m", [0.0, 100.0], "m"),
        Column::new("depth_m", [0.0, 100.0], "m"),
    ];
    let force = |[rake, soil_metal, friction, density_kg_m3, c, ca, width_m, depth_m]: [f64; 8]| {
        cutting_force(&CuttingInputs {
            rake: rake.to_radians(),
            soil_metal: soil_metal.to_radians(),
            friction: friction.to_radians(),
            density_kg_m3,
            cohesion_kpa: c,
            adhesion_kpa: ca,
            surcharge_kpa: 0.0,
            width_m,
            depth_m,
        })
    };
    let answers = table.rows.iter().zip(table.numbers(&columns)?);
    let answer = |(row, numbers): (&Row<'_>, [f64; 8])| match force(numbers) {
        Ok(found) => Ok(format!("{:?}", found.force_n)),
        Err(e) => Err(row.fault(format_args!("no plane of failure at these angles: {e}"))),
    };
    Ok(table.answered("force_n", answers.map(answer).collect::<Result<Vec<_>>>()?))
}

/// Needs the columns `c_kpa` (\[0, 10 000\]), `phi_deg` (\[0, 85\]) and `density_kg_m3` (\[1, 10 000\]). Answers with
/// the height at which an upright wall fails, `critical_height_m`.
///
/// # Errors
/// [`welkin::Status::Parse`] with line and column for wrong input.
pub fn walls(text: &str) -> Result<String> {
    let table = Table::read(text, "c_kpa,phi_deg,density_kg_m3")?;
    let columns = [
        Column::new("c_kpa", [0.0, 1e4], "kPa"),
        Column::new("phi_deg", [0.0, 85.0], "deg"),
        Column::new("density_kg_m3", [1.0, 1e4], "kg/m^3"),
    ];
    let height = |[cohesion_kpa, friction, density_kg_m3]: [f64; 3]| {
        WallLaw { cohesion_kpa, friction: friction.to_radians(), density_kg_m3 }.critical_height_m()
    };
    let answers = table.numbers(&columns)?.into_iter().map(|numbers| format!("{:?}", height(numbers)));
    Ok(table.answered("critical_height_m", answers))
}

/// Needs the columns `kc` (\[0, 1e6\] kN/m^(n+1)), `kphi` (\[0, 1e8\] kN/m^(n+2)), `n` (\[0.05, 3\]), `b_m` (\[0.001,
/// 100\]) and `p_kpa` (\[0, 1e6\]). Answers with Bekker's sinkage of a plate without an upper limit, `sinkage_m`. Also
/// returns a warning for each row beyond the range of such sets: n below 0.3, or a plate that sinks by more than its
/// width.
///
/// # Errors
/// [`welkin::Status::Parse`] with line and column for wrong input.
pub fn sinkages(text: &str) -> Result<(String, Vec<String>)> {
    let table = Table::read(text, "kc,kphi,n,b_m,p_kpa")?;
    let columns = [
        Column::new("kc", [0.0, 1e6], "kN/m^(n+1)"),
        Column::new("kphi", [0.0, 1e8], "kN/m^(n+2)"),
        Column::new("n", [0.05, 3.0], ""),
        Column::new("b_m", [1e-3, 100.0], "m"),
        Column::new("p_kpa", [0.0, 1e6], "kPa"),
    ];
    let mut warnings = Vec::new();
    let mut answers = Vec::new();
    for (row, [kc, kphi, n, width_m, pressure_kpa]) in table.rows.iter().zip(table.numbers(&columns)?) {
        let set = SinkageSet { kc, kphi, n };
        let sinkage_m = set.plate_m(width_m, pressure_kpa);
        if !sinkage_m.is_finite() {
            return Err(row.fault("kc and kphi must not both be 0, and the sinkage must be finite"));
        }
        if set.is_narrow() {
            warnings.push(row.fault("n is below 0.3: a fit of a small range of pressures").to_string());
        } else if sinkage_m > width_m {
            warnings.push(row.fault("the plate sinks by more than its width, beyond the range of the set").to_string());
        }
        answers.push(format!("{sinkage_m:?}"));
    }
    Ok((table.answered("sinkage_m", answers), warnings))
}

/// Needs the columns `volume_m3` (loose; \[1e-6, 1e6\]), `repose_deg` (\[5, 60\]) and `cell_m`, such that the heap's
/// radius is 3 to 160 cells. Pours each heap and answers with its radius at five azimuths, m: `r0,r11,r22,r34,r45`.
///
/// # Errors
/// [`welkin::Status::Parse`] with line and column for wrong input.
pub fn heaps(text: &str) -> Result<String> {
    let table = Table::read(text, "volume_m3,repose_deg,cell_m")?;
    let columns = [
        Column::new("volume_m3", [1e-6, 1e6], "m^3"),
        Column::new("repose_deg", [5.0, 60.0], "deg"),
        Column::new("cell_m", [1e-6, 1e6], "m"),
    ];
    let numbers: Vec<[f64; 3]> = table.numbers(&columns)?;
    let heap = |(row, [volume_m3, repose_deg, cell_m]): (&Row<'_>, [f64; 3])| {
        let radii = heap_radii_m(volume_m3, repose_deg, cell_m).map_err(|e| row.fault(e))?;
        Ok(radii.map(|radius_m| format!("{radius_m:.6}")).join(","))
    };
    let answers = table.rows.iter().zip(numbers).map(heap).collect::<Result<Vec<_>>>()?;
    Ok(table.answered("r0,r11,r22,r34,r45", answers))
}
