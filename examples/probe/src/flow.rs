//! `probe cavity`, `probe taylor-green`: flows with published results; `probe wind`: the wind in a scene.

use std::fmt::Write as _;

use glam::DVec3;
use welkin::{
    Error, Result, Status,
    flow::{
        Scheme,
        probe::{self, cavity},
    },
};

use crate::{
    csv::{Column, Table},
    scene::Scene,
};

/// A field counts as steady if it changes by at most this share of its largest speed while the wind crosses it.
const REST: f64 = 2e-3;
/// Maximum number of crossings to wait for a steady field.
const MOST_CROSSINGS: u32 = 60;
/// Latest time that a question may have, s.
const LATEST_S: f64 = 86_400.0;

/// The flow in the [`cavity`]: `y,u`, m and m/s, from the floor to the lid on the vertical centre line.
///
/// # Errors
/// As [`cavity`].
pub fn centre_line(re: f64, n: u32) -> Result<String> {
    let field = cavity(re, n)?;
    let mut out = String::from("y,u\n");
    let middles = (0..n).map(|j| (f64::from(j) + 0.5) / f64::from(n));
    for y in std::iter::once(0.0).chain(middles).chain([1.0]) {
        let u = field.velocity_at(DVec3::new(0.5, y, 0.0)).x;
        let _ = writeln!(out, "{y},{u}");
    }
    Ok(out)
}

/// [`probe::taylor_green`] as CSV: `kinetic_energy_kept`.
///
/// # Errors
/// As [`probe::taylor_green`].
pub fn taylor_green(n: u32, cfl: f64, scheme: Scheme) -> Result<String> {
    Ok(format!("kinetic_energy_kept\n{}\n", probe::taylor_green(n, cfl, scheme)?))
}

/// Needs columns `x,y,z` (m, in the scene's axes east, north, up) and `t` (s after the wind began to flow around the
/// obstacles). Answers with the wind there: `u,v,w`, m/s. In a steady scene the wind is the same at all times.
///
/// # Errors
/// [`Status::Parse`] with line and column for a faulty scene or faulty questions; [`Status::InvalidArgument`] for a
/// scene outside its ranges; [`Status::Unsupported`] if a steady field does not settle.
pub fn wind(scene: &str, text: &str) -> Result<String> {
    let scene = Scene::parse(scene)?;
    let mut field = scene.field()?;
    let corner = DVec3::from(scene.corner_m);
    let size = DVec3::from(scene.cells.map(f64::from)) * DVec3::from(scene.cell_m);
    let along = |name, a: usize| Column::new(name, [corner[a], corner[a] + size[a]], "");
    let table = Table::read(text, "x,y,z,t")?;
    let columns = [along("x", 0), along("y", 1), along("z", 2), Column::new("t", [0.0, LATEST_S], "")];
    let questions: Vec<[f64; 4]> = table.numbers(&columns)?;
    if scene.steady && !field.settle(scene.cfl, REST, MOST_CROSSINGS)? {
        let what = "the wind in this scene sheds whirls and does not rest: ask with steady = false";
        return Err(Error::new(Status::Unsupported, what));
    }
    let mut order: Vec<usize> = (0..questions.len()).collect();
    order.sort_by(|a, b| questions[*a][3].total_cmp(&questions[*b][3]));
    let mut answers = vec![String::new(); questions.len()];
    let (mut now, shortest) = (0.0, DVec3::from(scene.cell_m).min_element());
    for i in order {
        let [x, y, z, time_s] = questions[i];
        while !scene.steady && now < time_s {
            let most = scene.cfl * shortest / field.fastest_m_s().max(1e-3);
            let dt = most.min(time_s - now).min(1e3);
            field.step(dt)?;
            now += dt;
        }
        let v = field.velocity_at(DVec3::new(x, y, z) - corner);
        answers[i] = format!("{},{},{}", v.x, v.y, v.z);
    }
    Ok(table.answered("u,v,w", answers))
}
