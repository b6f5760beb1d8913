//! The front room: what a Rust host asks of views and contexts by the names of effects. The rooms below it name none.

mod view;
