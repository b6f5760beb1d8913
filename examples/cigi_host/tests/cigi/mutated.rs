//! Datagrams with changed bytes: none panics, hangs, or is read beyond its end. Seeded, so that a failure returns.

use crate::common::{Random, Slope, captures, is_accept, packets};
use welkin_cigi_host::capture::datagrams;
use welkin_cigi_host::map::{WeatherValues, map};
use welkin_cigi_host::session::Session;
use welkin_cigi_host::site::Site;
use welkin_cigi_host::wire::{Direction, Family, Message, Order, Value, Version, Writer};

/// Changes a datagram in one to eight places: single bytes, sizes, numbers that are likely to be tested, cuts, and
/// pieces of another datagram.
fn mutate(bytes: &mut Vec<u8>, others: &[Vec<u8>], random: &mut Random) {
    const LIKELY: [u8; 10] = [0, 1, 2, 3, 4, 8, 0x7f, 0x80, 0xf0, 0xff];
    for _ in 0..1 + random.below(8) {
        if bytes.is_empty() {
            bytes.push(random.next() as u8);
        }
        let place = random.below(bytes.len());
        match random.below(8) {
            0 | 1 => bytes[place] = random.next() as u8,
            2 => bytes[place] = LIKELY[random.below(LIKELY.len())],
            3 => bytes[place] ^= 1 << random.below(8),
            4 => bytes.truncate(place),
            5 => {
                let end = (place + 1 + random.below(8)).min(bytes.len());
                bytes.drain(place..end);
            }
            6 => {
                let other = &others[random.below(others.len())];
                let start = random.below(other.len());
                bytes.extend(&other[start..]);
                bytes.truncate(4096);
            }
            _ => {
                let floats = [f32::NAN, f32::INFINITY, -f32::MAX, f32::MIN_POSITIVE, 1e30, -0.0];
                let word = floats[random.below(floats.len())].to_le_bytes();
                let end = (place + 4).min(bytes.len());
                bytes[place..end].copy_from_slice(&word[..end - place]);
            }
        }
    }
}

fn all_datagrams() -> Vec<Vec<u8>> {
    let captures = captures();
    captures.iter().flat_map(|c| datagrams(&c.bytes).expect("whole datagrams")).map(<[u8]>::to_vec).collect()
}

#[test]
fn no_datagram_is_read_beyond_its_end() {
    let count = if is_accept() { 10_000_000 } else { 300_000 };
    let (good, mut random) = (all_datagrams(), Random(0x0ddb_a115));
    let mut writer = Writer::new(welkin_cigi_host::wire::Version::V4_0, Order::Big);
    let [mut opened, mut packets, mut refused] = [0u64; 3];
    let mut bytes = Vec::new();
    for i in 0..count {
        bytes.clear();
        bytes.extend(&good[i % good.len()]);
        mutate(&mut bytes, &good, &mut random);
        // In a vector of just this length, a read beyond it would be one beyond the slice, which Rust refuses by a
        // panic.
        let Ok(message) = Message::open(&bytes) else { continue };
        opened += 1;
        let mut end = 0;
        for placed in message.packets() {
            match placed {
                Ok(placed) => {
                    assert!(placed.offset >= end && placed.offset + placed.bytes.len() <= bytes.len());
                    end = placed.offset + placed.bytes.len();
                    packets += 1;
                    writer.restart(message.version, message.order);
                    if let Some(packet) = placed.packet {
                        writer.push(packet).expect("a packet that was read can be written");
                    }
                }
                Err(_) => refused += 1,
            }
        }
    }
    // Most are good enough to be looked into, and faults are found in many.
    assert!(opened > count as u64 / 2 && packets > opened && refused > opened / 20, "{opened} {packets} {refused}");
}

/// Checks that Welkin takes all values: the ranges are those of `welkin::weather::Weather`.
fn assert_ranges(weather: &WeatherValues, bytes: &[u8]) {
    let check = |name: &str, value: Option<f64>, low: f64, high: f64| {
        let is_good = value.is_none_or(|value| (low..=high).contains(&value));
        assert!(is_good, "{name} {value:?} after {bytes:?}");
    };
    check("temperature_c", weather.temperature_c, -90.0, 60.0);
    check("relative_humidity", weather.relative_humidity, 0.0, 1.0);
    check("pressure_hpa", weather.pressure_hpa, 800.0, 1100.0);
    check("visibility_m", weather.visibility_m, 1.0, 1e6);
    check("visibility_above_fog_m", weather.visibility_above_fog_m, 100.0, 1e6);
    check("flashes", Some(weather.flashes_per_minute), 0.0, 60.0);
    check("wind", weather.wind.map(|wind| wind.speed_m_s), 0.0, 120.0);
    check("from", weather.wind.map(|wind| wind.from_deg), 0.0, 360.0);
    check("fog.top_m", weather.fog.map(|fog| fog.top_m), 0.1, 2000.0);
    check("fog.visibility", weather.fog.map(|fog| fog.visibility_inside_m), 1.0, 1e4);
    check("fog.coverage", weather.fog.map(|fog| fog.coverage), 0.0, 1.0);
    check("lofted.top_m", weather.lofted.map(|lofted| lofted.top_m), 0.1, 5000.0);
    check("clouds", Some(weather.clouds.len() as f64), 0.0, 16.0);
    for cloud in &weather.clouds {
        check("cover", Some(cloud.cover), 0.0, 1.0);
        check("base_m", Some(cloud.base_m), 0.0, 2e4);
        check("thickness_m", Some(cloud.thickness_m), 1.0, 2e4);
        check("water_g_m3", Some(cloud.water_g_m3), 0.0, 10.0);
        check("cloud wind", Some(cloud.wind.speed_m_s), 0.0, 150.0);
        check("cloud from", Some(cloud.wind.from_deg), 0.0, 360.0);
    }
    check("rate", weather.precipitation.map(|fall| fall.rate_mm_h), 0.0, 500.0);
    check("liquid", weather.precipitation.map(|fall| fall.liquid_fraction), 0.0, 1.0);
    check("extinction", weather.precipitation.and_then(|fall| fall.extinction_per_m), 0.0, 10.0);
    check("water", weather.sea.temperature_c, -3.0, 45.0);
    check("waves", weather.sea.significant_wave_height_m, 0.0, 30.0);
    check("swell height", weather.sea.swell.map(|swell| swell[0]), 0.0, 20.0);
    check("swell period", weather.sea.swell.map(|swell| swell[1]), 1.0, 30.0);
    check("swell from", weather.sea.swell.map(|swell| swell[2]), 0.0, 360.0);
    check("snow_depth_m", weather.surface.map(|surface| surface.snow_depth_m), 0.0, 20.0);
    check("surface.coverage", weather.surface.map(|surface| surface.coverage), 0.0, 1.0);
}

#[test]
fn no_datagram_stops_a_session() {
    let count = if is_accept() { 1_000_000 } else { 30_000 };
    let (good, mut random) = (all_datagrams(), Random(0xbad_cafe));
    let from_host: Vec<&Vec<u8>> =
        good.iter().filter(|b| Message::open(b).is_ok_and(|m| m.direction == Direction::ToIg)).collect();
    let mut session = Session::new(Site::default(), Version::V3_3, Order::Little);
    let mut world = Slope::default();
    let [mut taken, mut answers] = [0usize; 2];
    let mut bytes = Vec::new();
    for i in 0..count {
        bytes.clear();
        bytes.extend(from_host[i % from_host.len()]);
        if i % 4 != 0 {
            mutate(&mut bytes, &good, &mut random);
        }
        taken += usize::from(session.receive(&bytes).is_ok());
        let sent = session.frame(i as u32, &mut world).to_vec();
        let sent = packets(&sent);
        answers += sent.len() - 1;
        // What is answered is finite, whatever was said.
        for packet in &sent {
            packet.visit(Family::V4, &mut |field, value| match value {
                Value::F32(number) => assert!(number.is_finite(), "{} {number} after {bytes:?}", field.name),
                Value::F64(number) => assert!(number.is_finite(), "{} {number} after {bytes:?}", field.name),
                _ => {}
            });
        }
        let mapped = map(session.state(), session.site());
        assert!(mapped.regions.len() <= 64);
        let weathers = mapped.regions.iter().map(|region| &region.weather).chain([&mapped.global]);
        weathers.for_each(|weather| assert_ranges(weather, &bytes));
    }
    assert!(taken > count / 2 && answers > count / 40, "{taken} {answers}");
    assert!(session.notes().iter().count() > 20);
}
