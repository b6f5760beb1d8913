//! Tests of the CIGI host program: captures, tables of offsets, changed datagrams, sessions, answers, the mapping, the
//! command line.
#![allow(clippy::type_complexity, reason = "tables of cases")]

mod answers;
mod captures;
mod common;
mod dissector;
mod map;
mod mutated;
mod session;
mod site;
mod tables;
mod tool;
