//! Visibility, fog and depth: the drawn functions against their f64 twins, and both against the published truths.

mod cameras;
mod contrast;
mod depth;
mod drawn;
mod gpu;
mod light;
mod path;
mod pictures;
mod probe;
mod slab;
