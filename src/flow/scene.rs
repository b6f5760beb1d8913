//! The wind in a scene, as CSV: `probe wind`.
//!
//! ```toml
//! cells = [64, 48, 24]        # east, north, up
//! cell_m = [4.0, 4.0, 2.0]
//! corner_m = [0.0, 0.0, 0.0]  # the lowest corner of the field
//! steady = false              # true: the mean wind, led on with an eddy viscosity until it rests; times do not matter
//! scheme = "reflection"
//! cfl = 2.0                   # cells that the fastest air passes in a step
//!
//! [wind]                      # at 10 m above the ground, logarithmic over it
//! speed_m_s = 8.0
//! from_deg = 270.0
//! roughness_m = 0.03
//!
//! [terrain]                   # optional: heights at the corners of squares, rows from south to north
//! corner_m = [0.0, 0.0]
//! cell_m = 64.0
//! heights_m = [[0, 3, 5, 5, 4], [0, 4, 8, 6, 4], [0, 2, 5, 5, 4], [0, 0, 3, 3, 2]]
//!
//! [[boxes]]
//! center_m = [90.0, 100.0, 12.0]
//! size_m = [16.0, 16.0, 24.0]
//! turned_deg = 30.0
//! ```

use std::fmt::Write as _;

use glam::{DVec2, DVec3};
use serde::Deserialize;

use super::{FlowBox, FlowField, FlowObstacles, FlowSettings, Scheme};
use crate::error::{Error, Result, Status, check_range, toml_fault};

/// A steady field changes by no more than this share of its largest speed while the wind crosses it.
const REST: f64 = 2e-3;
/// After so many crossings it is not waited for any longer.
const MOST_CROSSINGS: u32 = 60;
/// Latest time that can be asked for, s.
const LATEST_S: f64 = 86_400.0;

/// A scene file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Scene {
    cells: [u32; 3],
    cell_m: [f64; 3],
    #[serde(default)]
    corner_m: [f64; 3],
    #[serde(default)]
    steady: bool,
    scheme: Option<String>,
    #[serde(default = "usual_cfl")]
    cfl: f64,
    wind: SceneWind,
    terrain: Option<Terrain>,
    #[serde(default)]
    boxes: Vec<SceneBox>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SceneWind {
    speed_m_s: f64,
    from_deg: f64,
    #[serde(default = "grass")]
    roughness_m: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Terrain {
    corner_m: [f64; 2],
    cell_m: f64,
    heights_m: Vec<Vec<f64>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SceneBox {
    center_m: [f64; 3],
    size_m: [f64; 3],
    #[serde(default)]
    turned_deg: f64,
}

impl SceneWind {
    /// How the mean wind is mixed by its whirls, 10 m above the ground: kappa u* z (Prandtl 1925), u* = kappa U / ln(z / z0). What is
    /// solved for with it is a mean, and rests.
    fn eddy_viscosity_m2_s(&self) -> f64 {
        let friction_velocity_m_s = 0.4 * self.speed_m_s / libm::log(10.0 / self.roughness_m);
        0.4 * friction_velocity_m_s * 10.0
    }
}

fn usual_cfl() -> f64 {
    2.0
}

/// Roughness length of short grass, m.
fn grass() -> f64 {
    0.03
}

impl Terrain {
    fn check(&self) -> Result<()> {
        check_range("terrain.cell_m", self.cell_m, 1e-3, 1e5, "m")?;
        let columns = self.heights_m.first().map_or(0, Vec::len);
        if self.heights_m.len() < 2 || columns < 2 || self.heights_m.iter().any(|r| r.len() != columns) {
            return Err(Error::invalid(
                "terrain.heights_m",
                "must be two rows or more, each of as many numbers, two or more",
            ));
        }
        Ok(())
    }

    /// Linear between the nearest four heights; outside as at the edge.
    fn height_m(&self, place: DVec2) -> f64 {
        let at = (place - DVec2::from(self.corner_m)) / self.cell_m;
        let along = |v: f64, count: usize| {
            let v = v.clamp(0.0, (count - 1) as f64);
            let low = (v as usize).min(count - 2);
            (low, v - low as f64)
        };
        let (j, fy) = along(at.y, self.heights_m.len());
        let (i, fx) = along(at.x, self.heights_m[0].len());
        let row = |j: usize| self.heights_m[j][i] * (1.0 - fx) + self.heights_m[j][i + 1] * fx;
        row(j) * (1.0 - fy) + row(j + 1) * fy
    }
}

impl Scene {
    fn parse(text: &str) -> Result<Self> {
        let parse = |e: toml::de::Error| Error::new(Status::Parse, toml_fault(text, &e));
        let scene: Self = toml::from_str(text).map_err(parse)?;
        check_range("wind.speed_m_s", scene.wind.speed_m_s, 0.0, 150.0, "m/s")?;
        check_range("wind.from_deg", scene.wind.from_deg, 0.0, 360.0, "")?;
        check_range("wind.roughness_m", scene.wind.roughness_m, 1e-5, 2.0, "m")?;
        check_range("cfl", scene.cfl, 0.01, 64.0, "")?;
        for (i, b) in scene.boxes.iter().enumerate() {
            check_range(&format!("boxes[{i}].turned_deg"), b.turned_deg, -360.0, 360.0, "")?;
        }
        for v in scene.corner_m {
            check_range("corner_m", v, -1e7, 1e7, "m")?;
        }
        scene.terrain.as_ref().map_or(Ok(()), Terrain::check)?;
        Ok(scene)
    }

    /// The ground above the field's lowest corner.
    fn ground_m(&self, place: DVec2) -> f64 {
        let corner = DVec3::from(self.corner_m);
        self.terrain.as_ref().map_or(0.0, |t| t.height_m(place + corner.truncate()) - corner.z)
    }

    fn field(&self) -> Result<FlowField> {
        let scheme = self.scheme.as_deref().map_or(Ok(Scheme::default()), Scheme::from_name)?;
        let settings = FlowSettings {
            cells: self.cells,
            cell_m: DVec3::from(self.cell_m),
            scheme,
            viscosity_m2_s: if self.steady { self.wind.eddy_viscosity_m2_s() } else { 0.0 },
            ..FlowSettings::default()
        };
        let corner = DVec3::from(self.corner_m);
        let flow_box =
            |b: &SceneBox| FlowBox::level(DVec3::from(b.center_m) - corner, DVec3::from(b.size_m) / 2.0, b.turned_deg);
        let boxes: Vec<_> = self.boxes.iter().map(flow_box).collect();
        let ground = |place: DVec2| self.ground_m(place);
        let obstacles =
            FlowObstacles { terrain: self.terrain.is_some().then_some(&ground as super::Heights), boxes: &boxes };
        let from = self.wind.from_deg.to_radians();
        let toward = DVec3::new(-libm::sin(from), -libm::cos(from), 0.0);
        let z0 = self.wind.roughness_m;
        let share = |height: f64| libm::log(height.max(0.0) / z0 + 1.0) / libm::log(10.0 / z0 + 1.0);
        FlowField::new(&settings, &obstacles, |p| {
            toward * self.wind.speed_m_s * share(p.z - self.ground_m(p.truncate()))
        })
    }
}

/// A question: the line that it stands in, place and time.
struct Question<'a> {
    line: &'a str,
    place: DVec3,
    time_s: f64,
}

fn fault(line: usize, column: usize, what: impl std::fmt::Display) -> Error {
    Error::new(Status::Parse, format!("line {}, column {column}: {what}", line + 1))
}

/// Reads `x,y,z,t`, in any order, among other columns.
fn questions<'a>(text: &'a str, ranges: &[[f64; 2]; 4]) -> Result<(&'a str, Vec<Question<'a>>)> {
    const NAMES: [&str; 4] = ["x", "y", "z", "t"];
    let mut lines = text.lines().enumerate().filter(|(_, l)| !l.trim().is_empty());
    let (first, header) = lines.next().ok_or_else(|| fault(0, 1, "a header with x,y,z,t is missing"))?;
    let columns: Vec<&str> = header.split(',').map(str::trim).collect();
    let mut places = [0; 4];
    for (place, name) in places.iter_mut().zip(NAMES) {
        let found = columns.iter().position(|c| *c == name);
        *place = found.ok_or_else(|| fault(first, 1, format!("no column {name} among {columns:?}")))?;
    }
    let mut all = Vec::new();
    for (number, line) in lines {
        let fields: Vec<&str> = line.split(',').collect();
        if fields.len() != columns.len() {
            let what = format!("{} fields, the header has {}", fields.len(), columns.len());
            return Err(fault(number, line.chars().count() + 1, what));
        }
        let mut values = [0.0; 4];
        for (((value, place), name), [low, high]) in values.iter_mut().zip(places).zip(NAMES).zip(ranges) {
            let field = fields[place].trim();
            let found = field.parse::<f64>().ok().filter(|v| (low..=high).contains(&v));
            let at = 1 + fields[..place].iter().map(|f| f.chars().count() + 1).sum::<usize>();
            let what = || format!("{name} must be a number in [{low}, {high}], got {field:?}");
            *value = found.ok_or_else(|| fault(number, at, what()))?;
        }
        let [x, y, z, time_s] = values;
        all.push(Question { line, place: DVec3::new(x, y, z), time_s });
    }
    Ok((header, all))
}

/// Answers CSV with columns `x,y,z` (m, in the scene's axes east, north, up) and `t` (s after the wind began to flow round the
/// obstacles) with the wind there: `u,v,w`, m/s. In a steady scene all times are alike.
///
/// # Errors
/// [`Status::Parse`] with line and column for text that is no scene or no questions; [`Status::InvalidArgument`] for a scene outside
/// its ranges; [`Status::Unsupported`] where a steady field does not rest.
pub fn wind_csv(scene: &str, text: &str) -> Result<String> {
    let scene = Scene::parse(scene)?;
    let mut field = scene.field()?;
    let corner = DVec3::from(scene.corner_m);
    let size = DVec3::from(scene.cells.map(f64::from)) * DVec3::from(scene.cell_m);
    let range = |a: usize| [corner[a], corner[a] + size[a]];
    let (header, questions) = questions(text, &[range(0), range(1), range(2), [0.0, LATEST_S]])?;
    if scene.steady && !field.settle(scene.cfl, REST, MOST_CROSSINGS)? {
        let what = "the wind in this scene sheds whirls and does not rest: ask with steady = false";
        return Err(Error::new(Status::Unsupported, what));
    }
    let mut order: Vec<usize> = (0..questions.len()).collect();
    order.sort_by(|a, b| questions[*a].time_s.total_cmp(&questions[*b].time_s));
    let mut answers = vec![DVec3::ZERO; questions.len()];
    let (mut now, shortest) = (0.0, DVec3::from(scene.cell_m).min_element());
    for i in order {
        while !scene.steady && now < questions[i].time_s {
            let most = scene.cfl * shortest / field.fastest_m_s().max(1e-3);
            let dt = most.min(questions[i].time_s - now).min(1e3);
            field.step(dt)?;
            now += dt;
        }
        answers[i] = field.velocity_at(questions[i].place - corner);
    }
    let mut out = format!("{header},u,v,w\n");
    for (q, v) in questions.iter().zip(answers) {
        let _ = writeln!(out, "{},{},{},{}", q.line, v.x, v.y, v.z);
    }
    Ok(out)
}
