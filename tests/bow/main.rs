//! Rainbow and fogbow: one drop against Mie's theory, and both bows drawn.

mod drawn;
mod mie;
mod one_drop;
