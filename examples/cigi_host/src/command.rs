//! The command line.

use std::collections::BTreeSet;
use std::fs;
use std::net::{SocketAddr, UdpSocket};

use crate::capture::{self, Form};
use crate::session::Session;
use crate::site::Site;
use crate::udp::{Link, Pace};
use crate::wire::{Order, Version};
use crate::world::Groundless;

/// Usage text with every option.
pub const USAGE: &str = "\
usage: cigi_host --decode FILE.bin [--all] [--strict-ids]
       cigi_host --listen ADDRESS:PORT [--host ADDRESS:PORT] [--site FILE.toml] [--rate HERTZ | --lock-step]
                 [--cigi 3.3|4.0] [--frames N]
       cigi_host --help | --version

  --decode FILE.bin  print the packets of a capture as JSON: for each datagram its length as a little-endian
                     32-bit number, then its bytes
  --all              also the fields that hosts rarely use
  --strict-ids       leave the numbers of regional seas as they stand, also where a known fault has shifted them
  --listen ADDRESS   take a host's messages at this UDP address, such as 0.0.0.0:8000, and answer them
  --host ADDRESS     send there; without it, to the sender of the last good message
  --site FILE.toml   what CIGI leaves open: severities, layers, clouds, surfaces, components, altitudes
  --rate HERTZ       frames a second, [0.1, 1000]; default 60
  --lock-step        a frame with each message
  --cigi 3.3|4.0     version until the host's first message; default 3.3
  --frames N         end after so many frames";

/// Request of a command line.
#[derive(Debug, Default)]
struct Options {
    decode: Option<String>,
    has_all_fields: bool,
    is_strict: bool,
    listen: Option<SocketAddr>,
    host: Option<SocketAddr>,
    site: Option<String>,
    rate: Option<f64>,
    is_lock_step: bool,
    cigi: Option<Version>,
    frames: Option<u64>,
}

/// Text for standard output, and whether all went well.
#[derive(Debug)]
pub struct Output {
    /// Text.
    pub text: String,
    /// Packets or datagrams that were refused.
    pub refused: usize,
}

fn address(name: &str, text: &str) -> Result<SocketAddr, String> {
    text.parse().map_err(|_| format!("{name} must be an address with a port, such as 127.0.0.1:8000, not {text:?}"))
}

impl Options {
    fn parse(mut words: impl Iterator<Item = String>) -> Result<Self, String> {
        let mut options = Self::default();
        while let Some(name) = words.next() {
            let mut value = || words.next().ok_or_else(|| format!("{name} has no value"));
            match name.as_str() {
                "--decode" => options.decode = Some(value()?),
                "--all" => options.has_all_fields = true,
                "--strict-ids" => options.is_strict = true,
                "--listen" => options.listen = Some(address(&name, &value()?)?),
                "--host" => options.host = Some(address(&name, &value()?)?),
                "--site" => options.site = Some(value()?),
                "--rate" => {
                    let text = value()?;
                    let rate = text.parse().ok().filter(|rate| (0.1..=1000.0).contains(rate));
                    options.rate = Some(rate.ok_or_else(|| format!("--rate must be in [0.1, 1000], not {text:?}"))?);
                }
                "--lock-step" => options.is_lock_step = true,
                "--cigi" => {
                    options.cigi = Some(match value()?.as_str() {
                        "3.3" => Version::V3_3,
                        "4.0" => Version::V4_0,
                        other => return Err(format!("--cigi must be 3.3 or 4.0, not {other:?}")),
                    });
                }
                "--frames" => {
                    let text = value()?;
                    let frames = text.parse().ok().filter(|frames| *frames > 0);
                    options.frames =
                        Some(frames.ok_or_else(|| format!("--frames must be a number from 1 on, not {text:?}"))?);
                }
                other => return Err(format!("unknown option {other}")),
            }
        }
        options.check()?;
        Ok(options)
    }

    /// Refuses options that do not go together.
    fn check(&self) -> Result<(), String> {
        let decoding = [("--all", self.has_all_fields), ("--strict-ids", self.is_strict)];
        let linked = [
            ("--host", self.host.is_some()),
            ("--site", self.site.is_some()),
            ("--rate", self.rate.is_some()),
            ("--lock-step", self.is_lock_step),
            ("--cigi", self.cigi.is_some()),
            ("--frames", self.frames.is_some()),
        ];
        let (needed, others): (&str, &[(&str, bool)]) = match (&self.decode, self.listen) {
            (Some(_), Some(_)) => return Err("--decode and --listen exclude each other".to_owned()),
            (Some(_), None) => ("--listen", &linked),
            (None, Some(_)) => ("--decode", &decoding),
            (None, None) => return Err("--decode or --listen is missing".to_owned()),
        };
        if let Some((name, _)) = others.iter().find(|(_, is_given)| *is_given) {
            return Err(format!("{name} needs {needed}"));
        }
        if self.is_lock_step && self.rate.is_some() {
            return Err("--rate and --lock-step exclude each other".to_owned());
        }
        Ok(())
    }
}

/// Runs a command line.
///
/// # Errors
/// A sentence that names the option or the file and what is accepted.
pub fn run(words: impl Iterator<Item = String>) -> Result<Output, String> {
    let options = Options::parse(words).map_err(|e| format!("{e}\n{USAGE}"))?;
    match &options.decode {
        Some(path) => decode(path, &options),
        None => listen(&options),
    }
}

fn decode(path: &str, options: &Options) -> Result<Output, String> {
    let file = fs::read(path).map_err(|e| format!("{path}: {e}"))?;
    let datagrams = capture::datagrams(&file).map_err(|e| format!("{path}: {e}"))?;
    let form = Form { has_all_fields: options.has_all_fields, reads_early_ids: !options.is_strict };
    let decoded = capture::decode(&datagrams, form);
    Ok(Output { text: decoded.json, refused: decoded.refused })
}

fn listen(options: &Options) -> Result<Output, String> {
    let site = match &options.site {
        None => Site::default(),
        Some(path) => {
            let text = fs::read_to_string(path).map_err(|e| format!("{path}: {e}"))?;
            Site::from_toml(&text).map_err(|e| format!("{path}: {e}"))?
        }
    };
    let pace = if options.is_lock_step { Pace::LockStep } else { Pace::Rate(options.rate.unwrap_or(60.0)) };
    let listen = options.listen.ok_or("--listen is missing")?;
    let socket = UdpSocket::bind(listen).map_err(|e| format!("--listen {listen}: {e}"))?;
    let address = socket.local_addr().map_err(|e| format!("--listen {listen}: {e}"))?;
    eprintln!("cigi_host: listening at {address}");
    let mut world = Groundless { databases: site.databases.clone() };
    let version = options.cigi.unwrap_or(Version::V3_3);
    let session = Session::new(site, version, Order::native());
    let mut link = Link { socket, host: options.host, session, world: &mut world };
    let (mut said, mut mode, mut peer) = (BTreeSet::new(), None, None);
    let failed = |e: std::io::Error| format!("{address}: {e}");
    link.run(pace, options.frames, |session| {
        if peer != session.peer()
            && let Some((version, order)) = session.peer()
        {
            let order = if order == Order::Little { "little" } else { "big" };
            eprintln!("cigi_host: the host speaks CIGI {version}, {order}-endian");
            peer = session.peer();
        }
        if mode != Some(session.mode()) {
            eprintln!("cigi_host: {}", session.mode());
            mode = Some(session.mode());
        }
        if session.notes().iter().count() > said.len() {
            let new: Vec<_> = session.notes().iter().map(|(note, _)| *note).filter(|note| said.insert(*note)).collect();
            new.iter().for_each(|note| eprintln!("cigi_host: {note}"));
        }
    })
    .map_err(failed)?;
    let notes = link.session.notes().iter();
    let text = notes.map(|(note, count)| format!("{count} x {note}\n")).collect();
    Ok(Output { text, refused: 0 })
}
