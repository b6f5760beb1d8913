//! Order in which a model's tables over the planet are built: a list of passes, each with the tables that it reads and
//! draws.

use super::settings::{LIGHT_TILES, SkyModel, SkySettings};

/// Kind of a build pass; the names are the entry points of `sky/build.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PassKind {
    Norm,
    Gather,
    Scatter,
    Light,
    IsotropicGather,
    IsotropicScatter,
    Once,
}

/// Tables of a build. `Sources`, `Lights`, `OnceGas` and `OnceHaze` are its results. `Order(i)` and `OrderLight(i)` are
/// the source and the light of a single scattering order, where i alternates between 0 and 1 from order to order.
/// `PartSources` and `PartLights` are sums over the orders so far.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Name {
    Nothing,
    Norms,
    Radiances,
    Transfer,
    Order(usize),
    OrderLight(usize),
    PartSources,
    PartLights,
    Sources,
    Lights,
    OnceGas,
    OnceHaze,
}

impl Name {
    /// Tables that exist only during a build.
    pub const SCRATCH: [Name; 10] = [
        Name::Nothing,
        Name::Norms,
        Name::Radiances,
        Name::Transfer,
        Name::Order(0),
        Name::Order(1),
        Name::OrderLight(0),
        Name::OrderLight(1),
        Name::PartSources,
        Name::PartLights,
    ];
    /// Tables that remain after a build.
    pub const RESULTS: [Name; 4] = [Name::Sources, Name::Lights, Name::OnceGas, Name::OnceHaze];

    /// Tables that a build makes for one triple of wavelengths at a time, where there are several triples.
    pub const OF_A_TRIPLE: [Name; 2] = [Name::Sources, Name::Lights];

    /// Size of a result, texels. Sources of several triples are kept apart, one below the other.
    pub fn result_size(self, s: &SkySettings) -> (u32, u32) {
        let (width, height) = self.size(s);
        (width, if self == Name::Sources { height * s.layers() } else { height })
    }

    /// Size, texels, of the planet's light as it is shown. With [`SkyModel::BruteForce`] the sources lie below the
    /// light.
    pub fn shown_size(s: &SkySettings) -> (u32, u32) {
        let (light, sources) = (Self::Lights.size(s), Self::Sources.size(s));
        match s.model {
            SkyModel::BruteForce => (light.0.max(sources.0), light.1 + sources.1),
            _ => light,
        }
    }

    /// Size of a table as a build draws it, texels.
    pub fn size(self, s: &SkySettings) -> (u32, u32) {
        let (x, y) = match self {
            Name::Nothing => return (1, 1),
            Name::Norms => (1, 1),
            Name::Radiances => (s.rule_azimuths, 2 * s.rule_zeniths),
            Name::Transfer if s.model == SkyModel::IsotropicTables => (s.rule_azimuths, 2 * s.rule_zeniths),
            Name::OnceGas | Name::OnceHaze if s.model == SkyModel::Table3d => return (s.suns * 8, s.altitudes * 8),
            Name::Transfer | Name::OnceGas | Name::OnceHaze => return (1, 1),
            Name::Order(_) | Name::PartSources | Name::Sources if s.model.is_directional() => (s.azimuths, s.zeniths),
            Name::Order(_) | Name::PartSources | Name::Sources => (1, 1),
            Name::OrderLight(_) | Name::PartLights | Name::Lights => (LIGHT_TILES, 1),
        };
        (x * s.suns, y * s.altitudes)
    }
}

/// One pass of a build.
#[derive(Clone, Debug)]
pub(crate) struct Pass {
    pub kind: PassKind,
    /// Number of the scattering order to which the pass belongs.
    pub order: u32,
    /// Whether the orders after this one are added as a geometric series.
    pub last: bool,
    /// Tables that the pass reads: sources, radiances, light, sum of sources, sum of light, norms, as `sky/build.wgsl`
    /// binds them.
    pub reads: [Name; 6],
    /// Tables that the pass draws.
    pub draws: Vec<Name>,
}

impl Pass {
    fn new(kind: PassKind, order: u32, last: bool, reads: [Name; 6], draws: &[Name]) -> Self {
        Self { kind, order, last, reads, draws: draws.to_vec() }
    }

    /// Work of one texel, in nodes of a march, measured on the software driver.
    pub fn texel_cost(&self, s: &SkySettings) -> f64 {
        let directions = f64::from(2 * s.rule_zeniths * s.rule_azimuths);
        match self.kind {
            PassKind::Gather | PassKind::IsotropicGather => f64::from(4 * s.build_panels),
            PassKind::Once => f64::from(4 * s.sky_panels),
            PassKind::Scatter => 0.3 * directions,
            PassKind::Norm | PassKind::Light | PassKind::IsotropicScatter => 0.2 * directions,
        }
    }

    /// Time of one texel, in units of the time of a march's node: [`Pass::texel_cost`] times a factor measured on the
    /// software driver. Strips of a build are cut by this time, so that each frame takes equally long.
    pub fn texel_time(&self, s: &SkySettings) -> f64 {
        match self.kind {
            PassKind::Scatter => 0.24 * self.texel_cost(s),
            PassKind::Norm | PassKind::Light | PassKind::IsotropicScatter => 0.34 * self.texel_cost(s),
            _ => self.texel_cost(s),
        }
    }
}

/// Passes of a model.
pub(crate) fn passes(s: &SkySettings) -> Vec<Pass> {
    let mut out = vec![Pass::new(PassKind::Norm, 0, false, [Name::Nothing; 6], &[Name::Norms])];
    match s.model {
        SkyModel::Directional | SkyModel::BruteForce => directional(s, &mut out),
        SkyModel::IsotropicTables => isotropic(&mut out),
        SkyModel::Table3d => table3d(&mut out),
    }
    out
}

/// Pass that gathers light in the directions of the quadrature; it reads the order's source and the light of the order
/// before.
fn gather(order: u32, source: Name, light: Name) -> Pass {
    let reads = [source, Name::Nothing, light, Name::Nothing, Name::Nothing, Name::Norms];
    Pass::new(PassKind::Gather, order, false, reads, &[Name::Radiances])
}

/// Pass that draws the light of the order gathered last, and the sum of this light and the table `sum` into `target`.
fn light(order: u32, last: bool, sum: Name, target: Name) -> Pass {
    let n = order as usize;
    let (previous, now) = (Name::OrderLight((n + 1) % 2), Name::OrderLight(n % 2));
    let reads = [Name::Nothing, Name::Radiances, previous, Name::Nothing, sum, Name::Nothing];
    Pass::new(PassKind::Light, order, last, reads, &[now, target])
}

fn directional(s: &SkySettings, passes: &mut Vec<Pass>) {
    let count = s.orders - 1;
    for order in 1..=count {
        let last = order == count;
        let n = order as usize;
        // The sums alternate between two tables so that the last one is the result.
        let to_result = (count - order).is_multiple_of(2);
        let pick = |result, part| if to_result { (part, result) } else { (result, part) };
        let (before, now) = (Name::Order((n + 1) % 2), Name::Order(n % 2));
        passes.push(gather(order, before, Name::OrderLight((n + 1) % 2)));
        let (sum, target) = pick(Name::Lights, Name::PartLights);
        passes.push(light(order, last, sum, target));
        let (sum, target) = pick(Name::Sources, Name::PartSources);
        let reads = [before, Name::Radiances, Name::Nothing, sum, Name::Nothing, Name::Nothing];
        passes.push(Pass::new(PassKind::Scatter, order, last, reads, &[now, target]));
    }
}

fn isotropic(passes: &mut Vec<Pass>) {
    passes.push(Pass::new(PassKind::IsotropicGather, 1, false, [Name::Nothing; 6], &[Name::Radiances, Name::Transfer]));
    let reads = [Name::Transfer, Name::Radiances, Name::Nothing, Name::Nothing, Name::Nothing, Name::Nothing];
    passes.push(Pass::new(PassKind::IsotropicScatter, 1, false, reads, &[Name::Sources]));
    passes.push(gather(1, Name::Nothing, Name::Nothing));
    passes.push(light(1, false, Name::Lights, Name::PartLights));
    // Gathers all orders after the first at once.
    passes.push(gather(2, Name::Sources, Name::OrderLight(1)));
    passes.push(light(2, false, Name::PartLights, Name::Lights));
}

fn table3d(passes: &mut Vec<Pass>) {
    passes.push(Pass::new(PassKind::Once, 1, false, [Name::Nothing; 6], &[Name::OnceGas, Name::OnceHaze]));
    passes.push(gather(1, Name::Nothing, Name::Nothing));
    passes.push(light(1, false, Name::PartLights, Name::Lights));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_pass_reads_what_it_draws_and_results_are_drawn_last() {
        for (_, model) in SkyModel::NAMES {
            for orders in 3..=6 {
                let s = SkySettings { orders, ..SkySettings::with_model(model) };
                let list = passes(&s);
                for p in &list {
                    let own = |n: &Name| *n != Name::Nothing && p.draws.contains(n);
                    assert!(!p.reads.iter().any(own), "{model:?} {orders} {p:?}");
                    let size = p.draws[0].size(&s);
                    assert!(p.draws.iter().all(|d| d.size(&s) == size), "{model:?} {p:?}");
                }
                let last = |n: Name| list.iter().rposition(|p| p.draws.contains(&n));
                assert!(last(Name::Lights) > last(Name::PartLights), "{model:?} {orders}");
                if model != SkyModel::Table3d {
                    assert!(last(Name::Sources) >= last(Name::PartSources), "{model:?} {orders}");
                }
            }
        }
    }
}
