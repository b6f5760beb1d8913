//! Preparation of a frame's fog: the model from settings or weather.

use glam::DVec3;

use super::{
    curtains::Curtains,
    laws::{Curve, DistanceKind},
    layer::{FogLayer, Law, Patches, Profile},
    light::{Slab, Solution, delta_scaling},
    model::{FallingModel, FogKind, FogModel, PATCH_WAVES, Term},
    path::{falling_depth_above, layer_depth_above},
    viewpoint::{FogLight, Viewpoint},
};
use crate::{
    chance::RandomStream,
    error::{Result, check_range},
    falling::FallingLayer,
    light::{Phase, PhaseLobes},
    moment::MAX_EXTINCTION_PER_M,
    numerics::smoothstep,
};

/// Wavelengths of the channels, nm: those of the sky's three-channel tables. The green one is 550 nm, for which
/// Koschmieder's law is stated.
const WAVELENGTHS_NM: [f64; 3] = crate::light::EARTH_WAVELENGTHS_NM;

/// Smallest cosine of the sun's zenith angle. At 0 no light would enter a plane-parallel layer. On a curved planet the
/// light of a sun at the horizon enters a layer at a cosine of sqrt(2 thickness / radius), which is some thousandths.
const MIN_MU0: f64 = 0.01;

/// Product of diffusion exponent and depth below which a channel's two exponentials are drawn as a straight line. The
/// error is an eighth of its square.
const LINEAR_DIFFUSION: f64 = 0.05;

/// Scattering of a medium, as in [`FogLayer`].
struct FogScattering {
    /// Exponent of Angstrom's law sigma ~ wavelength^-a.
    angstrom: f64,
    /// Single-scattering albedo per channel, 0 to 1.
    albedo: [f64; 3],
    /// Phase function.
    phase: Phase,
}

impl FogScattering {
    /// Scattering by drops and flakes. The light under their cloud comes from all sides, so their phase function does
    /// not matter.
    const OF_FALLING: Self = Self { angstrom: 0.0, albedo: [1.0; 3], phase: Phase::HenyeyGreenstein { g: 0.0 } };

    /// Returns the scattering of a layer.
    fn of(layer: &FogLayer) -> Self {
        Self { angstrom: layer.angstrom, albedo: layer.albedo, phase: layer.phase }
    }

    /// Mixes in the scattering of precipitation, which has the share `share` of the optical depth. Phase functions are
    /// mixed while neither medium has more than twice the depth of the other.
    fn with_falling(&self, share: f64) -> Self {
        let mix = |a: f64, b: f64| a + (b - a) * share;
        let falling = Self::OF_FALLING;
        Self {
            angstrom: mix(self.angstrom, falling.angstrom),
            albedo: [0, 1, 2].map(|i| mix(self.albedo[i], falling.albedo[i])),
            phase: toward_even(self.phase, smoothstep(1.0 / 3.0, 2.0 / 3.0, share)),
        }
    }
}

/// Moves a phase function by `share` towards an isotropic one.
fn toward_even(phase: Phase, share: f64) -> Phase {
    match phase {
        same if share <= 0.0 => same,
        Phase::HenyeyGreenstein { g } => Phase::HenyeyGreenstein { g: g * (1.0 - share) },
        Phase::Droplets { diameter_um } => Phase::Between { diameter_um, g: 0.0, share },
        Phase::Between { diameter_um, g, share: there } => {
            Phase::Between { diameter_um, g: g * (1.0 - share), share: there + (1.0 - there) * share }
        }
    }
}

impl FogModel {
    /// Prepares the fog of one view and frame from a law.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the parameter.
    pub fn new(law: &Law, light: &FogLight, view: &Viewpoint) -> Result<Self> {
        light.validate()?;
        view.validate()?;
        let mut m = Self::clear(light, view);
        match law {
            Law::Clear => {}
            Law::Layer(layer) => {
                layer.validate()?;
                m.set_layer(layer, light, view);
            }
            Law::Compatibility(law) => {
                law.validate()?;
                m.distance = law.distance;
                m.sky_band = law.sky_band;
                m.first = law.colour.map_or_else(|| deep_layer_radiance(light), DVec3::from);
                (m.kind, m.extinction) = match law.curve {
                    Curve::Linear { .. } => (FogKind::Linear, 0.0),
                    Curve::Exponential { density_per_m } => (FogKind::ExponentialLaw, density_per_m),
                    Curve::ExponentialSquared { density_per_m } => (FogKind::ExponentialSquared, density_per_m),
                };
                if let Curve::Linear { start_m, end_m } = law.curve {
                    m.linear = [start_m, end_m];
                }
            }
        }
        Ok(m)
    }

    /// Returns a model without fog, with everything that does not depend on the law.
    fn clear(light: &FogLight, view: &Viewpoint) -> Self {
        Self {
            kind: FogKind::Clear,
            distance: DistanceKind::Range,
            altitude: view.altitude_m,
            curvature: 1.0 / (view.planet_radius_m + view.altitude_m),
            ground: view.ground_m,
            knots: [0.0; 4],
            inverse_flanks: [0.0; 2],
            extinction: 0.0,
            linear: [0.0, 1.0],
            sky_band: 0.0,
            ratio: DVec3::ONE,
            scaling: DVec3::ONE,
            depth_total: 0.0,
            to_sun: light.to_sun,
            inverse_mu0: 1.0 / light.to_sun.z.max(MIN_MU0),
            lobes: PhaseLobes::new(&Phase::HenyeyGreenstein { g: 0.0 }),
            forward: 0.0,
            smooth: 0.0,
            absorbing: false,
            k: DVec3::ZERO,
            constant: Term::default(),
            slope: Term::default(),
            beam: Term::default(),
            rise: Term::default(),
            fall: Term::default(),
            first: DVec3::ZERO,
            sky_radiance: DVec3::from(light.sky_irradiance) / std::f64::consts::PI,
            ground_radiance: DVec3::ZERO,
            solutions: None,
            lit: 1.0,
            patch_amount: 0.0,
            patch_waves: [(DVec3::ZERO, 0.0); PATCH_WAVES],
            detour: None,
            falling: FallingModel::NONE,
        }
    }

    /// Prepares the fog of a weather: its `layer`, if there is one, and its precipitation.
    ///
    /// The layer and the precipitation each have their own heights and extinction. They are lit as one medium, whose
    /// optical depth is the sum of both and whose scattering is their mean.
    ///
    /// # Errors
    /// Errors of [`FogModel::new`].
    pub fn of_weather(
        layer: Option<&FogLayer>,
        falling: &FallingLayer,
        light: &FogLight,
        view: &Viewpoint,
    ) -> Result<Self> {
        light.validate()?;
        view.validate()?;
        let mut m = Self::clear(light, view);
        if let Some(layer) = layer {
            layer.validate()?;
            m.set_shape(layer);
        }
        m.set_falling(falling)?;
        if let Some(layer) = layer {
            let whole = layer_depth_above(&m, view.ground_m);
            let share = if whole > 0.0 { falling_depth_above(&m, view.ground_m) / whole } else { 0.0 };
            m.set_light(&FogScattering::of(layer).with_falling(share), light, view);
        } else if m.falling.extinction > 0.0 {
            m.set_light(&FogScattering::OF_FALLING, light, view);
        }
        if let Some(patches) = layer.and_then(|l| l.patches.as_ref()) {
            m.set_patches(patches, view);
        }
        Ok(m)
    }

    /// Sets the precipitation.
    fn set_falling(&mut self, falling: &FallingLayer) -> Result<()> {
        check_range("falling.liquid_per_m", falling.liquid_per_m, 0.0, MAX_EXTINCTION_PER_M, "1/m")?;
        check_range("falling.solid_per_m", falling.solid_per_m, 0.0, MAX_EXTINCTION_PER_M, "1/m")?;
        check_range("falling.top_m", falling.top_m, -1e5, 1e6, "m")?;
        check_range("falling.soft_m", falling.soft_m, 1e-3, 1e5, "m")?;
        self.falling = FallingModel {
            extinction: falling.extinction_per_m().min(MAX_EXTINCTION_PER_M),
            top: [falling.top_m - falling.soft_m, falling.top_m],
            inverse_flank: 1.0 / falling.soft_m,
            curtains: Curtains::NONE,
        };
        Ok(())
    }

    /// Sets the whole layer: its shape, its light and its patches.
    fn set_layer(&mut self, layer: &FogLayer, light: &FogLight, view: &Viewpoint) {
        self.set_shape(layer);
        self.set_light(&FogScattering::of(layer), light, view);
        if let Some(patches) = &layer.patches {
            self.set_patches(patches, view);
        }
    }

    /// Sets the extinction of the layer and its change with altitude.
    fn set_shape(&mut self, layer: &FogLayer) {
        self.extinction = layer.extinction_per_m;
        (self.kind, self.knots) = match layer.profile {
            Profile::Slab { base_m, top_m, base_softness_m, top_softness_m } => {
                let most = top_m - base_m;
                let (b, t) = (0.5 * base_softness_m.min(most), 0.5 * top_softness_m.min(most));
                (FogKind::Slab, [base_m - b, base_m + b, top_m - t, top_m + t])
            }
            Profile::Exponential { reference_m, scale_height_m } => {
                (FogKind::Exponential, [reference_m, scale_height_m, 0.0, 0.0])
            }
        };
        if self.kind == FogKind::Slab {
            let [b0, b1, t0, t1] = self.knots;
            self.inverse_flanks = [b1 - b0, t1 - t0].map(|h| 1.0 / h.max(1e-3));
        }
    }

    /// Sets the light in the layer and the precipitation, which are lit as one medium with this scattering.
    fn set_light(&mut self, scattering: &FogScattering, light: &FogLight, view: &Viewpoint) {
        self.depth_total = layer_depth_above(self, view.ground_m);
        self.lobes = PhaseLobes::new(&scattering.phase);
        (self.forward, _, self.smooth) = delta_scaling(1.0, self.lobes.moments());
        let solutions = [0, 1, 2].map(|i| {
            let nm = WAVELENGTHS_NM[i];
            self.ratio[i] = (nm / WAVELENGTHS_NM[1]).powf(-scattering.angstrom);
            let (wf, albedo, asymmetry) = delta_scaling(scattering.albedo[i], self.lobes.moments());
            self.scaling[i] = self.ratio[i] * (1.0 - wf);
            let slab = Slab {
                depth: self.scaling[i] * self.depth_total,
                albedo,
                asymmetry,
                mu0: 1.0 / self.inverse_mu0,
                sun: light.sun_irradiance[i],
                sky: light.sky_irradiance[i],
                ground: light.ground_albedo[i],
            };
            // Shaders add the terms in f32, so their solution is kept farther from the pole at k mu0 = 1 than the
            // solution for queries.
            self.set_source(i, &slab.solve_beside(1e-4));
            self.first[i] = scattering.albedo[i] * light.sun_irradiance[i] / (1.0 - wf);
            slab.solve()
        });
        self.solutions = Some(solutions);
        self.lit = self.share_at(view.altitude_m);
    }

    /// Returns the light at an altitude below or in the layer, per channel. The first is the sun's light on a surface
    /// facing the sun, including the aureole (the forward peak of the scattering). The second is all other light on
    /// level ground. `None` if there is neither a layer nor precipitation.
    pub fn light_at(&self, altitude_m: f64) -> Option<[[f64; 3]; 2]> {
        let solutions = self.solutions?;
        let depth = layer_depth_above(self, altitude_m).min(self.depth_total);
        let one = |i: usize| {
            let s = &solutions[i];
            let t = self.scaling[i] * depth;
            (s.slab.sun * (-t / s.slab.mu0).exp(), s.irradiance_down(t)[1].max(0.0))
        };
        let [a, b, c] = [0, 1, 2].map(one);
        Some([[a.0, b.0, c.0], [a.1, b.1, c.1]])
    }

    /// Returns the share of a beam from a source at zenith cosine `mu0` that reaches an altitude, per channel,
    /// including its aureole.
    pub fn beam_share(&self, mu0: f64, altitude_m: f64) -> [f64; 3] {
        let depth = layer_depth_above(self, altitude_m).min(self.depth_total);
        (self.scaling * (-depth / mu0.max(MIN_MU0))).to_array().map(f64::exp)
    }

    /// Returns the share at 550 nm of the light above the layer that reaches level ground at an altitude.
    fn share_at(&self, altitude_m: f64) -> f64 {
        let (Some(all), Some([sun, sky])) = (&self.solutions, self.light_at(altitude_m)) else { return 1.0 };
        let Slab { mu0, sun: sun_above, sky: sky_above, .. } = all[1].slab;
        let above = mu0 * sun_above + sky_above;
        if above > 0.0 { ((mu0 * sun[1] + sky[1]) / above).min(1.0) } else { 1.0 }
    }

    /// Sets the source w (I0 + g mu I1) of channel `i`. The first scattering has its own term.
    fn set_source(&mut self, i: usize, s: &Solution) {
        let (w, g, depth) = (s.slab.albedo, s.slab.asymmetry, s.slab.depth);
        let set = |term: &mut Term, v: [f64; 2]| {
            term.even[i] = w * v[0];
            term.odd[i] = w * g * v[1];
        };
        set(&mut self.beam, s.beam.map(|v| -v));
        let e = (-s.k * depth).exp();
        if s.k * depth < LINEAR_DIFFUSION {
            let top = [0, 1].map(|j| s.constant[j] + s.rise[j] + s.fall[j] * e);
            let bottom = [0, 1].map(|j| s.constant[j] + s.slope[j] * depth + s.rise[j] * e + s.fall[j]);
            set(&mut self.constant, top);
            set(&mut self.slope, if s.k == 0.0 { s.slope } else { [0, 1].map(|j| (bottom[j] - top[j]) / depth) });
        } else {
            self.absorbing = true;
            self.k[i] = s.k;
            set(&mut self.rise, s.rise);
            set(&mut self.fall, s.fall);
        }
        self.ground_radiance[i] = s.irradiance_up(depth) / std::f64::consts::PI;
    }

    /// Sets the patches from four waves of similar length in different directions: the pattern is the square of their
    /// sum.
    fn set_patches(&mut self, patches: &Patches, view: &Viewpoint) {
        self.patch_amount = patches.amount;
        let mut stream = RandomStream::seeded(patches.seed);
        let mut random = move || stream.unit();
        let tau = std::f64::consts::TAU;
        let place = [view.map_m[0] - patches.drift_m[0], view.map_m[1] - patches.drift_m[1]];
        let waves: [([f64; 2], f64); 4] = std::array::from_fn(|i| {
            let angle = tau * (i as f64 + 0.8 * random()) / 4.0;
            let number = tau / patches.size_m * (0.45 + 0.3 * random());
            ([number * angle.cos(), number * angle.sin()], tau * random())
        });
        let pairs = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];
        for (slot, (a, b)) in self.patch_waves.iter_mut().zip(pairs) {
            let [ka, kb] = [waves[a].0, waves[b].0];
            let k = [ka[0] - kb[0], ka[1] - kb[1]];
            let phase = k[0] * place[0] + k[1] * place[1] + waves[a].1 - waves[b].1;
            *slot = (DVec3::new(k[0], k[1], 0.0), phase.rem_euclid(tau));
        }
    }
}

/// Returns the radiance of a deep layer of droplets under this light, in horizontal directions, one scaled depth below
/// its top.
fn deep_layer_radiance(light: &FogLight) -> DVec3 {
    let lobes = PhaseLobes::new(&Phase::Droplets { diameter_um: 15.0 });
    let (_, albedo, asymmetry) = delta_scaling(1.0, lobes.moments());
    let mu0 = light.to_sun.z.max(MIN_MU0);
    DVec3::from(std::array::from_fn(|i| {
        let (sun, sky, ground) = (light.sun_irradiance[i], light.sky_irradiance[i], light.ground_albedo[i]);
        Slab { depth: 10.0, albedo, asymmetry, mu0, sun, sky, ground }.solve().intensities(1.0)[0].max(0.0)
    }))
}
