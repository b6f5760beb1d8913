//! Captures in `tests/data`, the bits of a packet that a table names, and pseudorandom numbers.

use std::fs;
use std::path::{Path, PathBuf};

use welkin_cigi_host::wire::{Family, Packet, Role};

/// Whether the long runs of `make accept` are wanted.
pub fn is_accept() -> bool {
    std::env::var_os("WELKIN_ACCEPT").is_some_and(|v| v == "1")
}

/// A capture: its name without ending, its bytes, and its values as the packer stated them.
pub struct Capture {
    pub name: String,
    pub bytes: Vec<u8>,
    pub json: String,
}

pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data")
}

pub fn captures() -> Vec<Capture> {
    let mut names: Vec<PathBuf> =
        fs::read_dir(folder()).expect("the captures").map(|e| e.expect("a file").path()).collect();
    names.retain(|path| path.extension().is_some_and(|e| e == "bin"));
    names.sort();
    let read = |path: PathBuf| Capture {
        name: path.file_stem().expect("a name").to_string_lossy().into_owned(),
        bytes: fs::read(&path).expect("a capture"),
        json: fs::read_to_string(path.with_extension("json")).expect("its values"),
    };
    names.into_iter().map(read).collect()
}

/// Returns the bits of a packet that the header and the table's fields take.
pub fn named_bits(packet: &Packet, family: Family, size: usize) -> Vec<u8> {
    let mut mask = vec![0; size];
    let header = if family == Family::V3 { 2 } else { 4 };
    mask.iter_mut().take(header).for_each(|byte| *byte = 0xff);
    for field in packet.layout().fields.iter().filter(|field| field.role != Role::Child) {
        if let Some((offset, count)) = field.slot(family).bytes() {
            let bytes = mask.iter_mut().skip(offset).take(count);
            bytes.for_each(|byte| *byte |= field.slot(family).mask());
        }
    }
    mask
}

/// Pseudorandom numbers (Marsaglia 2003, xorshift64*).
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_f491_4f6c_dd1d)
    }

    pub fn below(&mut self, end: usize) -> usize {
        ((self.next() >> 32) as usize * end) >> 32
    }

    /// A number in [low, high).
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }
}

use welkin_cigi_host::geodesy::Place;
use welkin_cigi_host::wire::{
    EnvironmentalConditionsRequest, EnvironmentalRegionControl, IgControl, Message, Order, Version, WeatherControl,
    Writer,
};
use welkin_cigi_host::world::{Loading, Terrain, World};

pub const VERSIONS: [Version; 4] = [Version::V3_0, Version::V3_2, Version::V3_3, Version::V4_0];
pub const ORDERS: [Order; 2] = [Order::Little, Order::Big];

/// Returns a message from a host in operate mode.
pub fn message(version: Version, order: Order, frame: u32, packets: &[Packet]) -> Vec<u8> {
    with_first(version, order, IgControl { ig_mode: 1, host_frame_number: frame, ..IgControl::default() }, packets)
}

pub fn with_first(version: Version, order: Order, first: IgControl, packets: &[Packet]) -> Vec<u8> {
    let mut writer = Writer::new(version, order);
    writer.push(first).expect("room");
    packets.iter().for_each(|packet| writer.push(*packet).expect("room and a form"));
    writer.bytes().to_vec()
}

/// Returns all packets of a message, each of which must be good.
pub fn packets(bytes: &[u8]) -> Vec<Packet> {
    let message = Message::open(bytes).expect("a message");
    message.packets().map(|placed| placed.expect("a good packet").packet.expect("a known one")).collect()
}

/// A world with ground at 100 m plus 1 m a degree of latitude, west of Greenwich only; its databases take two frames,
/// and 13 fails.
#[derive(Default)]
pub struct Slope {
    pub loads: usize,
}

impl World for Slope {
    fn terrain(&mut self, place: Place) -> Option<Terrain> {
        let height_m = 100.0 + place.latitude_deg;
        (place.longitude_deg < 0.0).then_some(Terrain { height_m, normal_deg: [180.0, 89.0], material: 7 })
    }

    fn load(&mut self, database: u8) -> Loading {
        self.loads += 1;
        match (database, self.loads % 2) {
            (13, _) => Loading::Failed,
            (_, 0) => Loading::Ready,
            _ => Loading::Underway,
        }
    }
}

/// Returns the shape of a region of 6 by 4 km.
pub fn region(region_id: u16, latitude_deg: f64, longitude_deg: f64) -> EnvironmentalRegionControl {
    EnvironmentalRegionControl {
        region_id,
        region_state: 1,
        latitude_deg,
        longitude_deg,
        size_x_m: 6000.0,
        size_y_m: 4000.0,
        corner_radius_m: 1000.0,
        rotation_deg: 20.0,
        transition_perimeter_m: 1500.0,
        ..EnvironmentalRegionControl::default()
    }
}

/// Returns rain from the ground to 900 m.
pub fn rain(scope: u8, id: u16) -> WeatherControl {
    WeatherControl {
        scope,
        entity_or_region_id: id,
        layer_id: 4,
        humidity_percent: 94,
        weather_enable: true,
        severity: 3,
        air_temperature_c: 15.0,
        visibility_m: 3000.0,
        coverage_percent: 100.0,
        thickness_m: 900.0,
        transition_band_m: 40.0,
        bottom_transition_m: 40.0,
        top_transition_m: 40.0,
        horizontal_wind_mps: 9.0,
        wind_from_deg: -100.0,
        pressure_hpa: 1010.0,
        aerosol_g_m3: 0.75,
        ..WeatherControl::default()
    }
}

pub fn request(request_id: u8, bits: u8, place: Place) -> EnvironmentalConditionsRequest {
    let Place { latitude_deg, longitude_deg, altitude_m } = place;
    EnvironmentalConditionsRequest { request_type_bits: bits, request_id, latitude_deg, longitude_deg, altitude_m }
}
