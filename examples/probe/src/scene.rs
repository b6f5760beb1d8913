//! The scene file of `probe wind`.
//!
//! ```toml
//! cells = [64, 48, 24]        # east, north, up
//! cell_m = [4.0, 4.0, 2.0]
//! corner_m = [0.0, 0.0, 0.0]  # the lowest corner of the field
//! steady = false              # true: the mean wind, simulated with an eddy viscosity until steady; times are ignored
//! scheme = "reflection"
//! cfl = 2.0                   # cells that the fastest air crosses in a step
//!
//! [wind]                      # at 10 m above the ground; logarithmic profile
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

use glam::{DVec2, DVec3};
use serde::Deserialize;

use welkin::{
    Error, Result, Status,
    error::{check_range, toml_fault},
    flow::{FlowBox, FlowField, FlowObstacles, FlowSettings, Heights, Scheme},
};

/// The parsed scene file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    pub cells: [u32; 3],
    pub cell_m: [f64; 3],
    #[serde(default)]
    pub corner_m: [f64; 3],
    #[serde(default)]
    pub steady: bool,
    scheme: Option<String>,
    #[serde(default = "usual_cfl")]
    pub cfl: f64,
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
    /// Eddy viscosity of the mean wind, 10 m above the ground: kappa u* z (Prandtl 1925), u* = kappa U / ln(z / z0).
    /// The solution with it is a mean wind, which becomes steady.
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

    /// Height by bilinear interpolation; outside the terrain, the height at its edge.
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
    /// # Errors
    /// [`Status::Parse`] with line and column; [`Status::InvalidArgument`] for values outside their ranges.
    pub fn parse(text: &str) -> Result<Self> {
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

    /// Height of the ground above the field's lowest corner.
    fn ground_m(&self, place: DVec2) -> f64 {
        let corner = DVec3::from(self.corner_m);
        self.terrain.as_ref().map_or(0.0, |t| t.height_m(place + corner.truncate()) - corner.z)
    }

    /// Creates the scene's air at the moment when the wind begins to blow.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`].
    pub fn field(&self) -> Result<FlowField> {
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
        let obstacles = FlowObstacles { terrain: self.terrain.is_some().then_some(&ground as Heights), boxes: &boxes };
        let from = self.wind.from_deg.to_radians();
        let toward = DVec3::new(-libm::sin(from), -libm::cos(from), 0.0);
        let z0 = self.wind.roughness_m;
        let share = |height: f64| libm::log(height.max(0.0) / z0 + 1.0) / libm::log(10.0 / z0 + 1.0);
        FlowField::new(&settings, &obstacles, |p| {
            toward * self.wind.speed_m_s * share(p.z - self.ground_m(p.truncate()))
        })
    }
}
