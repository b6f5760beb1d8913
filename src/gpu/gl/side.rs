//! Side of a target that a host's image belongs to: colour, depth, mask, classes or normals.

/// Side of a target that an image belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TargetSide {
    Color,
    Depth,
    Mask,
    Classes,
    Normals,
}

impl TargetSide {
    /// Returns the noun for the image in messages.
    pub(super) fn noun(self) -> &'static str {
        &self.parameter()["target.".len()..]
    }

    /// Returns the field's path in errors.
    pub(super) fn parameter(self) -> &'static str {
        match self {
            Self::Color => "target.color",
            Self::Depth => "target.depth",
            Self::Mask => "target.mask",
            Self::Classes => "target.surface_classes",
            Self::Normals => "target.normals",
        }
    }
}
