//! Visibility, fog and depth: the drawn functions against their f64 references, and both against published values.

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
