//! A session's answers as another reader sees them: Wireshark's dissector, field by field, where `tshark` is installed.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

use crate::common::{ORDERS, Slope, message, packets, rain, region, request};
use welkin_cigi_host::geodesy::Place;
use welkin_cigi_host::session::Session;
use welkin_cigi_host::site::Site;
use welkin_cigi_host::wire::{
    AtmosphereControl, HatHotRequest, MaritimeSurfaceConditionsControl, Order, Packet,
    TerrestrialSurfaceConditionsControl, Value, Version,
};

/// Packets, their names in the dissector, and for each field the two names.
const NAMES: [(&str, &str, &[(&str, &str)]); 7] = [
    (
        "Start of Frame",
        "sof",
        &[
            ("database_number", "db_number"),
            ("ig_status", "ig_status"),
            ("ig_mode", "ig_mode"),
            ("timestamp_valid", "timestamp_valid"),
            ("earth_reference_model", "earth_reference_model"),
            ("minor_version", "minor_version"),
            ("ig_frame_number", "ig_frame_number"),
            ("timestamp_10us", "timestamp"),
            ("last_host_frame_number", "last_host_frame_number"),
        ],
    ),
    (
        "Maritime Surface Conditions Response",
        "maritime_surface_conditions_response",
        &[
            ("request_id", "request_id"),
            ("sea_surface_height_m", "sea_surface_height"),
            ("water_temperature_c", "surface_water_temp"),
            ("clarity_percent", "surface_clarity"),
        ],
    ),
    (
        "Terrestrial Surface Conditions Response",
        "terr_surface_cond_response",
        &[("request_id", "request_id"), ("surface_condition_id", "surface_id")],
    ),
    (
        "Weather Conditions Response",
        "wea_cond_response",
        &[
            ("request_id", "request_id"),
            ("humidity_percent", "humidity"),
            ("air_temperature_c", "air_temp"),
            ("visibility_m", "visibility_range"),
            ("horizontal_wind_mps", "horiz_speed"),
            ("vertical_wind_mps", "vert_speed"),
            ("wind_from_deg", "wind_direction"),
            ("pressure_hpa", "barometric_pressure"),
        ],
    ),
    (
        "Aerosol Concentration Response",
        "aerosol_concentration_response",
        &[("request_id", "request_id"), ("layer_id", "layer_id"), ("aerosol_g_m3", "aerosol_concentration")],
    ),
    (
        "HAT/HOT Response",
        "hat_hot_response",
        &[
            ("hat_hot_id", "hat_hot_id"),
            ("valid", "valid"),
            ("response_type", "type"),
            ("host_frame_number_lsn", "host_frame_number_lsn"),
            ("height_m", "height"),
        ],
    ),
    (
        "HAT/HOT Extended Response",
        "hat_hot_ext_response",
        &[
            ("hat_hot_id", "hat_hot_id"),
            ("valid", "valid"),
            ("host_frame_number_lsn", "host_frame_number_lsn"),
            ("hat_m", "hat"),
            ("hot_m", "hot"),
            ("material_code", "material_code"),
            ("normal_azimuth_deg", "normal_vector_azimuth"),
            ("normal_elevation_deg", "normal_vector_elevation"),
        ],
    ),
];

/// Returns a session's answers to a request of each kind.
fn answers(version: Version, order: Order) -> Vec<u8> {
    let place = Place { latitude_deg: 43.4, longitude_deg: -5.1, altitude_m: 50.0 };
    let air = AtmosphereControl {
        humidity_percent: 55,
        air_temperature_c: 18.5,
        visibility_m: 35_000.0,
        horizontal_wind_mps: 4.25,
        vertical_wind_mps: -0.5,
        wind_from_deg: 280.0,
        pressure_hpa: 1014.5,
        ..AtmosphereControl::default()
    };
    let sea = MaritimeSurfaceConditionsControl {
        sea_surface_height_m: 0.75,
        water_temperature_c: 20.5,
        clarity_percent: 90.0,
        ..MaritimeSurfaceConditionsControl::default()
    };
    let ground = TerrestrialSurfaceConditionsControl {
        surface_condition_id: 0x1234,
        surface_condition_enable: true,
        ..TerrestrialSurfaceConditionsControl::default()
    };
    let height = |hat_hot_id, request_type| HatHotRequest {
        hat_hot_id,
        request_type,
        latitude_deg: 43.5,
        longitude_deg: -5.1,
        altitude_m: 1000.0,
        ..HatHotRequest::default()
    };
    let all: [Packet; 10] = [
        air.into(),
        region(7, 43.4, -5.1).into(),
        rain(1, 7).into(),
        sea.into(),
        ground.into(),
        request(9, 15, place).into(),
        height(0x102, 0).into(),
        height(0x203, 1).into(),
        height(0x304, 2).into(),
        request(10, 4, Place { latitude_deg: 42.0, ..place }).into(),
    ];
    let mut session = Session::new(Site::default(), Version::V3_3, Order::native());
    session.receive(&message(version, order, 0x0102_0305, &all)).expect("a good message");
    session.frame(0x1112_1314, &mut Slope::default()).to_vec()
}

/// Returns a capture of Ethernet in pcap's form: each datagram in UDP from port 8001 to 8000.
fn pcap(datagrams: &[Vec<u8>]) -> Vec<u8> {
    let mut out = Vec::new();
    for word in [0xa1b2_c3d4u32, 0x0004_0002, 0, 0, 65_535, 1] {
        out.extend(word.to_le_bytes());
    }
    for datagram in datagrams {
        let length = datagram.len() + 42;
        for word in [0, 0, length as u32, length as u32] {
            out.extend(word.to_le_bytes());
        }
        out.extend([2, 0, 0, 0, 0, 1, 2, 0, 0, 0, 0, 2, 8, 0]);
        let [high, low] = (length as u16 - 14).to_be_bytes();
        out.extend([0x45, 0, high, low, 0, 0, 0, 0, 64, 17, 0, 0, 127, 0, 0, 1, 127, 0, 0, 1]);
        let [high, low] = (length as u16 - 34).to_be_bytes();
        out.extend([0x1f, 0x41, 0x1f, 0x40, high, low, 0, 0]);
        out.extend(datagram);
    }
    out
}

/// Returns what the dissector reads: for each field its values in the order of the packets.
fn dissected(datagram: &[u8], name: &str) -> BTreeMap<String, Vec<f64>> {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("cigi-{name}.pcap"));
    // Version 4.6 of tshark does not know the version of CIGI 3 yet in the first datagram.
    fs::write(&path, pcap(&[datagram.to_vec(), datagram.to_vec()])).expect("the target directory is writable");
    let fields: Vec<String> = NAMES
        .iter()
        .flat_map(|(_, packet, fields)| fields.iter().map(move |(_, f)| format!("cigi.{packet}.{f}")))
        .collect();
    let mut tshark = Command::new("tshark");
    tshark.arg("-r").arg(&path).args(["-d", "udp.port==8000,cigi", "-T", "fields", "-E", "separator=;"]);
    for field in &fields {
        tshark.args(["-e", field]);
    }
    let done = tshark.output().expect("tshark starts");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let text = String::from_utf8(done.stdout).expect("text");
    let values = |cell: &str| {
        let number = |text: &str| match text {
            "True" => 1.0,
            "False" => 0.0,
            text => text.parse().unwrap_or_else(|_| panic!("{name}: {text:?}")),
        };
        cell.split(',').filter(|text| !text.is_empty()).map(number).collect::<Vec<f64>>()
    };
    let last = text.lines().last().expect("a line for each datagram");
    fields.into_iter().zip(last.split(';').map(values)).collect()
}

/// Returns the newest version of CIGI that `tshark` reads; `None` if it is not installed.
fn newest_known() -> Option<Version> {
    let said = match Command::new("tshark").arg("--version").output() {
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => return None,
        said => String::from_utf8(said.expect("tshark starts").stdout).expect("text"),
    };
    let words =
        said.lines().next().and_then(|line| line.split_whitespace().find(|word| word.starts_with(char::is_numeric)));
    let numbers: Vec<u32> = words.expect("a version").split('.').filter_map(|number| number.parse().ok()).collect();
    Some(if numbers >= vec![4, 6] { Version::V4_0 } else { Version::V3_3 })
}

#[test]
fn wireshark_reads_the_answers_as_they_are_meant() {
    let Some(newest) = newest_known() else {
        println!("skipped: tshark is not here");
        return;
    };
    if newest != Version::V4_0 {
        println!("skipped: this tshark does not know CIGI 4.0, 4.6 does");
    }
    for version in [Version::V3_2, Version::V3_3, newest] {
        for order in ORDERS {
            let bytes = answers(version, order);
            let mut read = dissected(&bytes, &format!("{version}-{order:?}"));
            read.retain(|_, values| !values.is_empty());
            let mut meant: BTreeMap<String, Vec<f64>> = BTreeMap::new();
            for packet in packets(&bytes) {
                let name = packet.layout().name;
                let (_, theirs, fields) = NAMES.iter().find(|(ours, ..)| *ours == name).expect("a name");
                packet.visit(version.family(), &mut |field, value| {
                    let Some((_, field)) = fields.iter().find(|(ours, _)| *ours == field.name) else { return };
                    let number = match value {
                        Value::Bool(on) => f64::from(u8::from(on)),
                        Value::Int(number) => number as f64,
                        Value::F32(number) => number.into(),
                        Value::F64(number) => number,
                    };
                    meant.entry(format!("cigi.{theirs}.{field}")).or_default().push(number);
                });
            }
            assert!(meant.keys().eq(read.keys()), "{version} {order:?}: {meant:?} {read:?}");
            for (field, meant) in &meant {
                let read = &read[field];
                assert_eq!(meant.len(), read.len(), "{version} {order:?} {field}: {meant:?} {read:?}");
                // The dissector prints six digits of a 32-bit number.
                let same = meant.iter().zip(read).all(|(a, b)| (a - b).abs() <= 1e-5 * a.abs().max(1e-3));
                assert!(same, "{version} {order:?} {field}: {meant:?} {read:?}");
            }
        }
    }
}
