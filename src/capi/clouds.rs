//! Clouds
//!
//! Layers of cloud come with the weather: wk_cloud_layer, a report, a preset. wk_context_set_cloud_model says how views
//! draw them. Light, queries and what falls are the same either way. docs/clouds.md has pictures' costs and errors.

use super::{
    boundary::guard,
    context::{ContextObject, wk_context},
    input, layout,
    status::*,
};
use crate::{clouds::CloudModel, error::Status};

/// How clouds are drawn.
pub type wk_cloud_model = u32;
/// A grey deck where more than half of the sky is covered; broken clouds only dim the light. It costs no more than a
/// clear sky.
pub const WK_CLOUD_MODEL_DECK: wk_cloud_model = 0;
/// Layers of a volume that one can fly through, lit by sun or moon, sky and ground. A closed layer seen from below is
/// drawn as a deck. A sixteenth of the pixels is computed in a frame: count wk_frame.frame_id up by one.
pub const WK_CLOUD_MODEL_VOLUME: wk_cloud_model = 1;

/// Sets how views draw clouds. Default WK_CLOUD_MODEL_DECK. Part of the saved state.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT for an unknown model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_set_cloud_model(
    context: *mut wk_context,
    cloud_model: wk_cloud_model,
) -> wk_status {
    guard("wk_context_set_cloud_model", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        input::check_enum("cloud_model", &layout::WK_CLOUD_MODEL, cloud_model)?;
        let model = if cloud_model == WK_CLOUD_MODEL_VOLUME { CloudModel::Volume } else { CloudModel::Deck };
        object.write().set_cloud_model(model);
        Ok(Status::Ok)
    })
}
