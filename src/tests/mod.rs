//! Tests of several rooms together that look at what no host can see.

mod moment;
mod opaque;
