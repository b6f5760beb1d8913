//! Cost of a way to draw an effect, in units of work that do not depend on a machine.

/// A way to draw an effect, as its room lists it.
#[derive(Clone, Debug, PartialEq)]
pub struct Listed<M> {
    /// Name of the method, unique within the effect, in lower case with hyphens.
    pub name: &'static str,
    /// Parameters with which the method is built.
    pub method: M,
    /// Cost of the method.
    pub work: Work,
}

/// Amounts of work. A sample is one point of a march or one integral in closed form: densities, exponentials, a sum.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Units {
    /// Points at which the medium is evaluated.
    pub samples: f64,
    /// Filtered look-ups.
    pub texels: f64,
    /// Bytes written.
    pub bytes: f64,
}

impl Units {
    /// Returns the sum of these amounts and `times` times `other`.
    pub fn plus(self, other: Self, times: f64) -> Self {
        Self {
            samples: self.samples + times * other.samples,
            texels: self.texels + times * other.texels,
            bytes: self.bytes + times * other.bytes,
        }
    }

    /// Returns the amounts as one number, in samples.
    pub fn at(self, price: &Price) -> f64 {
        self.samples + price.texel * self.texels + price.byte * self.bytes
    }
}

/// Costs of a look-up and of a byte, in samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Price {
    /// Samples that take as long as a filtered look-up.
    pub texel: f64,
    /// Samples that take as long as a byte written.
    pub byte: f64,
}

impl Default for Price {
    /// Returns the costs that `lab chart` fitted to a software driver, where look-ups are dear (docs/lab).
    fn default() -> Self {
        Self { texel: 6.4, byte: 0.8 }
    }
}

/// Cost of a candidate, split by how often each amount is paid.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Work {
    /// Work whenever the air changes, once for all views.
    pub rebuild: Units,
    /// Work for each view, whatever the number of its pixels. The sky does it per lamp (sun or moon), whenever the
    /// view's altitude, the lamp or the air changes. Other effects do it in every frame.
    pub view: Units,
    /// Work for every pixel of every frame; for the sky, per lamp.
    pub pixel: Units,
    /// Memory held once for all views, bytes.
    pub shared_bytes: u64,
    /// Memory held by each view, bytes.
    pub view_bytes: u64,
}

impl Work {
    /// Returns the work of one view's frame under one lamp (sun or moon). `follows` says whether the work of
    /// [`Work::view`] is done in this frame.
    pub fn frame(&self, pixels: u64, follows: bool) -> Units {
        let view = if follows { self.view } else { Units::default() };
        view.plus(self.pixel, pixels as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_pays_for_what_changed() {
        let work = Work {
            view: Units { samples: 100.0, ..Default::default() },
            pixel: Units { texels: 2.0, ..Default::default() },
            ..Default::default()
        };
        let price = Price { texel: 0.5, byte: 1.0 };
        assert_eq!(work.frame(10, false).at(&price), 10.0);
        assert_eq!(work.frame(10, true).at(&price), 110.0);
    }
}
