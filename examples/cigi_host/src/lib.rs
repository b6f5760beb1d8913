//! The image generator's side of CIGI, the standard by which simulator hosts drive image generators, without drawing.
//!
//! [`wire`] reads and writes datagrams, [`state`] keeps what the host has said, [`answer`] answers its requests,
//! [`session`] ties these together for one host, and [`udp`] runs a session over the network. [`site`] is the table of
//! what CIGI leaves open. [`map`] turns the state into what Welkin's weather takes. [`capture`] prints files of
//! datagrams.

#![forbid(unsafe_code)]

pub mod answer;
pub mod capture;
pub mod command;
pub mod geodesy;
mod json;
pub mod map;
pub mod notes;
pub mod session;
pub mod site;
pub mod state;
pub mod udp;
pub mod wire;
pub mod world;
