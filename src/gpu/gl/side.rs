//! Side of a target that a host's image serves: colour, depth, mask, classes or normals.

/// Side of a target that an image serves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TargetSide {
    Color,
    Depth,
    Mask,
    Classes,
    Normals,
}

impl TargetSide {
    /// Returns the noun for the image's contents, in messages.
    pub(super) fn noun(self) -> &'static str {
        &self.parameter()["target.".len()..]
    }

    /// The field's path in errors.
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
