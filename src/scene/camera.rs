//! Camera of the host: position, orientation and projection.

use glam::{DMat3, DMat4, DVec3, DVec4};

use crate::error::{Error, Result};

/// One camera of the host. Matrices are column-major and act on column vectors, as in OpenGL, Vulkan and glam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Position in the host's world, m.
    pub position: DVec3,
    /// World to eye. Only its rotation is used; `position` holds the translation at full precision.
    pub view: DMat4,
    /// Eye to clip: any projection, off-axis, stereo, orthographic, reversed or infinite.
    pub projection: DMat4,
}

impl Camera {
    /// Creates a perspective camera at `position` that looks along `forward`, with reversed infinite depth and
    /// zero-to-one clip space. `forward` and `up_direction` may have any length, but must not be parallel.
    pub fn look_to(
        position: DVec3,
        forward: DVec3,
        up_direction: DVec3,
        fov_y_rad: f64,
        aspect: f64,
        near_m: f64,
    ) -> Self {
        let focal = 1.0 / (0.5 * fov_y_rad).tan();
        let projection = DMat4::from_cols(
            DVec4::new(focal / aspect, 0.0, 0.0, 0.0),
            DVec4::new(0.0, focal, 0.0, 0.0),
            DVec4::new(0.0, 0.0, 0.0, -1.0),
            DVec4::new(0.0, 0.0, near_m, 0.0),
        );
        let f = forward.normalize();
        let r = f.cross(up_direction).normalize();
        let view = DMat4::from_mat3(DMat3::from_cols(r, r.cross(f), -f).transpose());
        Self { position, view, projection }
    }

    /// Checks that the matrices are finite and invertible and that `view` holds a rotation; the error names the field.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`].
    pub fn validate(&self) -> Result<()> {
        if !self.position.is_finite() {
            return Err(Error::range("camera.position", "finite, in metres", self.position));
        }
        let r = DMat3::from_mat4(self.view);
        if !self.view.is_finite()
            || !((r.transpose() * r) - DMat3::IDENTITY).to_cols_array().iter().all(|v| v.abs() < 1e-3)
        {
            return Err(Error::range("camera.view", "a rigid world-to-eye matrix (rotation, no scale)", self.view));
        }
        let d = self.projection.determinant();
        if !self.projection.is_finite() || !d.is_finite() || d == 0.0 {
            return Err(Error::range("camera.projection", "finite and invertible", self.projection));
        }
        Ok(())
    }

    /// Returns the rotation of `view`, world to eye.
    pub fn rotation(&self) -> DMat3 {
        DMat3::from_mat4(self.view)
    }

    /// Whether the rays are parallel.
    pub fn is_orthographic(&self) -> bool {
        let r = self.projection.row(3);
        r.x == 0.0 && r.y == 0.0 && r.z == 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_matrices_are_named() {
        let good = Camera::look_to(DVec3::ZERO, DVec3::Y, DVec3::Z, 1.0, 1.6, 0.1);
        assert!(good.validate().is_ok());
        let scaled = Camera { view: good.view * DMat4::from_scale(DVec3::splat(2.0)), ..good };
        assert!(scaled.validate().unwrap_err().to_string().contains("camera.view"));
        let flat = Camera { projection: DMat4::ZERO, ..good };
        assert!(flat.validate().unwrap_err().to_string().contains("camera.projection"));
        let lost = Camera { position: DVec3::new(f64::NAN, 0.0, 0.0), ..good };
        assert!(lost.validate().unwrap_err().to_string().contains("camera.position"));
    }
}
