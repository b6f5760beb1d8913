//! Sessions: modes, databases, frame numbers, versions and byte orders; a scripted host over loopback UDP in lock-step.

use std::net::UdpSocket;
use std::time::Duration;

use crate::common::{ORDERS, Random, Slope, VERSIONS, message, packets, rain, region, request, with_first};
use welkin_cigi_host::geodesy::Place;
use welkin_cigi_host::session::{Mode, Session};
use welkin_cigi_host::site::Site;
use welkin_cigi_host::udp::{Link, Pace};
use welkin_cigi_host::wire::{
    AtmosphereControl, EntityControl, EntityPosition, HatHotRequest, IgControl, Message, Order, Packet, StartOfFrame,
    Version, ViewControl,
};

const PLACE: Place = Place { latitude_deg: 43.4, longitude_deg: 5.1, altitude_m: 50.0 };

fn session() -> Session {
    Session::new(Site::default(), Version::V3_3, Order::Little)
}

fn start_of_frame(bytes: &[u8]) -> StartOfFrame {
    match packets(bytes)[0] {
        Packet::StartOfFrame(first) => first,
        other => panic!("the first packet is {other:?}"),
    }
}

#[test]
fn answers_have_the_host_s_version_and_order() {
    let mut session = session();
    // Before the host speaks, messages have the version that was chosen, and the mode is standby.
    let first = start_of_frame(session.frame(1, &mut Slope::default()));
    assert_eq!((first.major_version, first.minor_version, first.ig_mode, first.database_number), (3, 3, 0, 0));
    assert_eq!(session.peer(), None);
    let mut frame = 1;
    for version in VERSIONS {
        for order in ORDERS {
            frame += 1;
            let asked = [request(frame as u8, 15, PLACE).into()];
            session.receive(&message(version, order, 1000 + frame, &asked)).expect("a good message");
            let bytes = session.frame(7 * frame, &mut Slope::default()).to_vec();
            let opened = Message::open(&bytes).expect("a message");
            assert_eq!((opened.version, opened.order), (version, order));
            assert_eq!(bytes.len() % 8, 0);
            let first = start_of_frame(&bytes);
            let echo = if version == Version::V3_0 { 0 } else { 1000 + frame };
            assert_eq!((first.ig_frame_number, first.last_host_frame_number), (frame, echo), "{version}");
            assert_eq!((first.timestamp_10us, first.timestamp_valid, first.ig_mode), (7 * frame, true, 1));
            let names: Vec<&str> = packets(&bytes).iter().map(|packet| packet.layout().name).collect();
            let wanted =
                ["Start of Frame", "Maritime Surface Conditions Response", "Terrestrial Surface Conditions Response"];
            assert_eq!(names, [&wanted[..], &["Weather Conditions Response"]].concat());
        }
    }
}

#[test]
fn in_standby_nothing_but_the_mode_counts() {
    let mut session = session();
    let air = AtmosphereControl { air_temperature_c: 21.0, visibility_m: 9000.0, ..AtmosphereControl::default() };
    let first = IgControl { ig_mode: 0, database_number: 3, host_frame_number: 5, ..IgControl::default() };
    let all = [air.into(), region(3, 43.0, 5.0).into(), request(1, 15, PLACE).into()];
    session.receive(&with_first(Version::V3_3, Order::Big, first, &all)).expect("a good message");
    let answer = session.frame(0, &mut Slope::default()).to_vec();
    assert_eq!((packets(&answer).len(), start_of_frame(&answer).database_number), (1, 0));
    assert_eq!(session.state(), &Default::default());
    session.receive(&message(Version::V3_3, Order::Big, 6, &all)).expect("a good message");
    assert_eq!((session.mode(), session.state().regions.len()), (Mode::Operate, 1));
    assert_eq!(session.state().atmosphere.temperature_c, 21.0);
    // Mode 3 is the image generator's own choice.
    let other = IgControl { ig_mode: 3, host_frame_number: 7, ..IgControl::default() };
    session.receive(&with_first(Version::V3_3, Order::Big, other, &[])).expect("a good message");
    assert_eq!((session.mode(), session.notes().count("IG Control", "ig_mode")), (Mode::Operate, 1));
    // Standby takes everything back.
    session.receive(&with_first(Version::V3_3, Order::Big, first, &[])).expect("a good message");
    assert_eq!((session.mode(), session.state()), (Mode::Standby, &Default::default()));
}

#[test]
fn the_database_number_is_negative_until_loaded_and_acknowledged() {
    let mut session = session();
    let mut world = Slope::default();
    let mut step = |database_number: i8, wanted: i8| {
        let first = IgControl { ig_mode: 1, database_number, ..IgControl::default() };
        session.receive(&with_first(Version::V4_0, Order::Little, first, &[])).expect("a good message");
        let said = start_of_frame(session.frame(0, &mut world)).database_number;
        assert_eq!(said, wanted, "after {database_number}");
    };
    step(0, 0);
    step(3, -3); // Loading.
    step(3, -3); // Ready, but the host has not said that it saw.
    step(0, 3);
    step(0, 3);
    step(13, -128); // Fails.
    step(0, -128);
    step(5, -5);
    step(0, 5);
    step(-1, 5); // No request.
}

#[test]
fn heights_are_answered_by_the_world_or_as_not_valid() {
    for (version, order) in [(Version::V3_3, Order::Big), (Version::V4_0, Order::Little)] {
        let mut session = session();
        let mut world = Slope::default();
        let entity = EntityControl {
            entity_id: 4,
            entity_state: 1,
            latitude_deg: 40.0,
            longitude_deg: -3.0,
            altitude_m: 500.0,
            yaw_deg: 90.0,
            ..EntityControl::default()
        };
        let position = EntityPosition {
            entity_id: 4,
            latitude_deg: 40.0,
            longitude_deg: -3.0,
            altitude_m: 500.0,
            yaw_deg: 90.0,
            ..EntityPosition::default()
        };
        let ask = |hat_hot_id, request_type, longitude_deg| HatHotRequest {
            hat_hot_id,
            request_type,
            latitude_deg: 30.0,
            longitude_deg,
            altitude_m: 1000.0,
            ..HatHotRequest::default()
        };
        let below = HatHotRequest {
            hat_hot_id: 9,
            coordinate_system: 1,
            entity_id: 4,
            x_offset_m: 10.0,
            z_offset_m: 20.0,
            ..HatHotRequest::default()
        };
        let repeated = HatHotRequest { update_period: 3, ..ask(6, 1, -1.0) };
        let lost = HatHotRequest { hat_hot_id: 8, coordinate_system: 1, entity_id: 77, ..HatHotRequest::default() };
        let mut all: Vec<Packet> = vec![entity.into()];
        if version == Version::V4_0 {
            all.push(position.into());
        }
        all.extend(
            [ask(1, 0, -1.0), ask(2, 1, -1.0), ask(3, 2, -1.0), ask(5, 0, 1.0), repeated, lost, below]
                .map(Packet::from),
        );
        session.receive(&message(version, order, 0x1234, &all)).expect("a good message");
        let answers = packets(session.frame(0, &mut world));
        assert_eq!(answers.len(), 8);
        for answer in &answers[1..] {
            match *answer {
                Packet::HatHotResponse(answer) => {
                    assert_eq!(answer.host_frame_number_lsn, 4);
                    let wanted = match answer.hat_hot_id {
                        1 => (true, 0, 870.0),
                        2 | 6 => (true, 1, 130.0),
                        9 => (true, 0, 340.0),
                        _ => (false, 0, 0.0),
                    };
                    let got = (answer.valid, answer.response_type, answer.height_m);
                    assert_eq!((got.0, got.1), (wanted.0, wanted.1), "{answer:?}");
                    assert!((got.2 - wanted.2).abs() < 1e-3, "{answer:?}");
                }
                Packet::HatHotExtendedResponse(answer) => {
                    assert_eq!((answer.hat_hot_id, answer.valid, answer.hat_m, answer.hot_m), (3, true, 870.0, 130.0));
                    let normal = (answer.normal_azimuth_deg, answer.normal_elevation_deg);
                    assert_eq!((answer.material_code, normal), (7, (180.0, 89.0)));
                }
                other => panic!("{other:?}"),
            }
        }
        assert_eq!(session.notes().count("HAT/HOT Request", ""), 2);
        // The request with a period is answered every third frame, the others never again.
        let counts: Vec<usize> = (0..6).map(|_| packets(session.frame(0, &mut world)).len()).collect();
        assert_eq!(counts, [1, 1, 2, 1, 1, 2]);
    }
}

#[test]
fn ignored_packets_are_counted_by_name() {
    let mut session = session();
    let good = message(Version::V3_3, Order::Little, 1, &[]);
    let mut second = good.clone();
    second.extend(&good);
    second.extend([17, 24].iter().chain(&[0; 22]));
    second.extend([250, 8, 0, 0, 0, 0, 0, 0]);
    second.extend([12, 48].iter().chain(&[0; 46]));
    session.receive(&second).expect("the first packet is good");
    let said: Vec<String> = session.notes().iter().map(|(note, count)| format!("{count} {note}")).collect();
    let wanted = [
        "1 IG Control: ignored, it does not belong there",
        "1 Sensor Control: ignored, this program has no use for it",
        "1 User-defined packet: ignored, this program has no use for it",
        "1 Weather Control: ignored, its size is wrong",
    ];
    assert_eq!(said, wanted);
    let before = format!("{:?}", session.state());
    for bad in [&good[..20], &good[1..], &[]] {
        assert!(session.receive(bad).is_err());
    }
    // A message of an image generator is none for it.
    let own = session.frame(0, &mut Slope::default()).to_vec();
    assert!(session.receive(&own).is_err());
    assert_eq!(session.notes().count("datagram", "") + session.notes().count("Start of Frame", ""), 4);
    assert_eq!(format!("{:?}", session.state()), before);
    // More requests than there is room for.
    let many: Vec<Packet> = (0..300).map(|i| request(i as u8, 4, PLACE).into()).collect();
    session.receive(&message(Version::V4_0, Order::Little, 2, &many)).expect("a good message");
    assert_eq!(session.notes().count("Environmental Conditions Request", ""), 44);
    assert_eq!(packets(session.frame(0, &mut Slope::default())).len(), 257);
}

#[test]
fn views_stand_where_their_entities_carry_them() {
    let mut session = session();
    let root = EntityControl {
        entity_state: 1,
        latitude_deg: 10.0,
        longitude_deg: 179.9995,
        altitude_m: 100.0,
        yaw_deg: 90.0,
        ..EntityControl::default()
    };
    let child = EntityControl {
        entity_id: 1,
        entity_state: 1,
        attach_state: 1,
        x_offset_m: 100.0,
        z_offset_m: -5.0,
        yaw_deg: -90.0,
        ..EntityControl::default()
    };
    let view = ViewControl {
        view_id: 2,
        entity_id: 1,
        enable_bits: 0b100_001,
        x_offset_m: 50.0,
        yaw_deg: 30.0,
        ..ViewControl::default()
    };
    let circle =
        |entity_id, parent_id| EntityControl { entity_id, entity_state: 1, attach_state: 1, parent_id, ..child };
    let all = [root.into(), child.into(), view.into(), circle(7, 8).into(), circle(8, 7).into()];
    session.receive(&message(Version::V3_3, Order::Little, 1, &all)).expect("a good message");
    let pose = session.state().view_pose(2).expect("a pose");
    // 100 m east of the entity across the date line, 50 m north and 5 m up of that.
    let circle_m =
        6_378_137.0 / (1.0 - 0.006_694_38 * 10f64.to_radians().sin().powi(2)).sqrt() * 10f64.to_radians().cos();
    let east_m = (pose.place.longitude_deg + 360.0 - 179.9995).to_radians() * circle_m;
    let north_m = (pose.place.latitude_deg - 10.0).to_radians() * 6_337_000.0;
    assert!((east_m - 100.0).abs() < 0.01 && (north_m - 50.0).abs() < 0.01, "{east_m} {north_m}");
    assert!((pose.place.altitude_m - 105.0).abs() < 1e-9);
    let forward = pose.attitude.turned([1.0, 0.0, 0.0]);
    let wanted = [30f64.to_radians().cos(), 30f64.to_radians().sin(), 0.0];
    assert!(forward.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-12), "{forward:?}");
    assert_eq!(session.state().entity_pose(7), None, "parents in a circle");
    // A destroyed parent takes its children with it.
    let gone = EntityControl { entity_state: 2, ..root };
    session.receive(&message(Version::V3_3, Order::Little, 2, &[gone.into()])).expect("a good message");
    assert_eq!((session.state().entities.len(), session.state().view_pose(2)), (2, None));
}

/// A thunderstorm that crosses a site, with weather packets in every message, and requests in every tenth.
fn storm(frame: u32) -> Vec<Packet> {
    let air = AtmosphereControl {
        humidity_percent: 60,
        air_temperature_c: 20.0,
        visibility_m: 20_000.0,
        horizontal_wind_mps: 5.0,
        wind_from_deg: 240.0,
        pressure_hpa: 1004.0,
        ..AtmosphereControl::default()
    };
    let mut all: Vec<Packet> =
        vec![air.into(), region(7, 43.4, 5.0 + 4e-4 * f64::from(frame)).into(), rain(1, 7).into()];
    if frame.is_multiple_of(10) {
        all.extend([request(frame as u8, 4, PLACE), request(frame as u8 + 1, 8, PLACE)].map(Packet::from));
    }
    all
}

#[test]
fn a_scripted_host_and_the_session_go_in_lock_step() {
    const FRAMES: u32 = 600;
    for version in [Version::V3_3, Version::V4_0] {
        for order in ORDERS {
            let socket = UdpSocket::bind("127.0.0.1:0").expect("a port");
            let address = socket.local_addr().expect("an address");
            let other = if version == Version::V4_0 { Version::V3_3 } else { Version::V4_0 };
            let ig = std::thread::spawn(move || {
                let mut world = Slope::default();
                let session = Session::new(Site::default(), other, Order::native());
                let mut link = Link { socket, host: None, session, world: &mut world };
                let mut frames = 0;
                link.run(Pace::LockStep, Some(FRAMES.into()), |_| frames += 1).expect("the socket works");
                (frames, link.session.notes().iter().count())
            });
            let host = UdpSocket::bind("127.0.0.1:0").expect("a port");
            host.set_read_timeout(Some(Duration::from_secs(20))).expect("a time");
            let mut visibilities = Vec::new();
            let mut buffer = [0; 2048];
            for frame in 0..FRAMES {
                host.send_to(&message(version, order, 5000 + frame, &storm(frame)), address).expect("sent");
                let length = host.recv(&mut buffer).expect("an answer to each message");
                let opened = Message::open(&buffer[..length]).expect("a message");
                assert_eq!((opened.version, opened.order), (version, order));
                let first = start_of_frame(&buffer[..length]);
                assert_eq!((first.ig_frame_number, first.last_host_frame_number), (frame + 1, 5000 + frame));
                let answers = packets(&buffer[..length]);
                assert!(answers.len() >= if frame.is_multiple_of(10) { 2 } else { 1 } && answers.len() <= 3);
                for answer in &answers[1..] {
                    match answer {
                        Packet::WeatherConditionsResponse(air) if air.request_id == frame as u8 => {
                            visibilities.push(air.visibility_m)
                        }
                        Packet::AerosolConcentrationResponse(air) => {
                            assert_eq!((air.request_id, air.layer_id), (frame as u8 + 1, 4))
                        }
                        other => panic!("{other:?}"),
                    }
                }
            }
            assert_eq!(ig.join().expect("no panic"), (u64::from(FRAMES), 0));
            // The storm comes, stays and goes: from clear air through its perimeter to the rain, and back.
            let (first, last) = (visibilities[0], visibilities[visibilities.len() - 1]);
            let least = visibilities.iter().copied().fold(f32::INFINITY, f32::min);
            assert!((first, last) == (20_000.0, 20_000.0) && (least - 3000.0).abs() < 0.01, "{visibilities:?}");
            assert!(visibilities.iter().any(|v| (3100.0..19_000.0).contains(v)), "{visibilities:?}");
        }
    }
}

#[test]
fn a_session_sends_the_first_message_and_ignores_other_senders() {
    let socket = UdpSocket::bind("127.0.0.1:0").expect("a port");
    let address = socket.local_addr().expect("an address");
    let host = UdpSocket::bind("127.0.0.1:0").expect("a port");
    let known = host.local_addr().expect("an address");
    let ig = std::thread::spawn(move || {
        let mut world = Slope::default();
        let session = Session::new(Site::default(), Version::V4_0, Order::Big);
        let mut link = Link { socket, host: Some(known), session, world: &mut world };
        link.run(Pace::Rate(200.0), Some(60), |_| {}).expect("the socket works");
        link.session.host_frame_number()
    });
    host.set_read_timeout(Some(Duration::from_secs(20))).expect("a time");
    let mut buffer = [0; 256];
    let length = host.recv(&mut buffer).expect("a message before the host's first");
    assert_eq!(Message::open(&buffer[..length]).map(|m| (m.version, m.order)), Ok((Version::V4_0, Order::Big)));
    // Two messages for one frame: the last number is echoed.
    let mut random = Random(3);
    for frame in [41, 42] {
        host.send_to(&message(Version::V3_3, Order::Little, frame, &[]), address).expect("sent");
        host.send_to(&random.next().to_le_bytes(), address).expect("sent");
    }
    let mut last = 0;
    while last != 42 {
        let length = host.recv(&mut buffer).expect("more messages");
        last = start_of_frame(&buffer[..length]).last_host_frame_number;
    }
    assert_eq!(ig.join().expect("no panic"), 42);
}

#[test]
fn an_impossible_rate_and_a_flood_of_messages_stop_neither_reading_nor_frames() {
    for pace in [Pace::Rate(1e9), Pace::Rate(f64::NAN), Pace::Rate(-1.0), Pace::Rate(1e-300), Pace::Rate(30.0)] {
        let socket = UdpSocket::bind("127.0.0.1:0").expect("a port");
        let address = socket.local_addr().expect("an address");
        let host = UdpSocket::bind("127.0.0.1:0").expect("a port");
        for frame in 1..=50 {
            host.send_to(&message(Version::V4_0, Order::Big, frame, &[]), address).expect("sent");
            host.send_to(&[frame as u8; 40], address).expect("sent");
        }
        let mut world = Slope::default();
        let session = Session::new(Site::default(), Version::V3_3, Order::Little);
        let mut link = Link { socket, host: None, session, world: &mut world };
        link.run(pace, Some(1), |_| {}).expect("the socket works");
        assert_eq!(link.session.host_frame_number(), 50, "{pace:?}");
        assert_eq!(link.session.notes().count("datagram", ""), 50, "{pace:?}");
        host.set_read_timeout(Some(Duration::from_secs(20))).expect("a time");
        let mut buffer = [0; 256];
        let length = host.recv(&mut buffer).expect("an answer");
        assert_eq!(start_of_frame(&buffer[..length]).last_host_frame_number, 50, "{pace:?}");
    }
}
