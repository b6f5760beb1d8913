//! Droplet diameters for which all contexts share the tables of multiple scattering (`clouds::light::transport`).

use crate::weather::CloudSlab;

/// Droplet diameters with shared scattering tables, um.
pub(crate) const LIQUID_UM: [f64; 5] = [8.0, 12.0, 16.0, 20.0, 30.0];

/// Returns the diameter of [`LIQUID_UM`] that is nearest to the layers' mean droplet diameter, by ratio, um. The mean
/// weights each layer by its cover times its share of liquid water. Without liquid water the answer is the smallest
/// diameter.
pub(crate) fn nearest_diameter<'a>(slabs: impl Iterator<Item = &'a CloudSlab>) -> f64 {
    let add = |(water, sum): (f64, f64), s: &CloudSlab| {
        let liquid = s.cover * (1.0 - s.ice_fraction);
        (water + liquid, sum + liquid * s.droplet_radius_um)
    };
    let (water, sum) = slabs.fold((0.0, 0.0), add);
    let diameter = (2.0 * sum / water.max(1e-6)).max(1.0);
    let off = |um: &f64| (um / diameter).ln().abs();
    LIQUID_UM.into_iter().min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(diameter)
}
