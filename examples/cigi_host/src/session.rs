//! The exchange with one host: its version and byte order, modes, databases, frame numbers, requests and their answers.
//!
//! A session takes datagrams and makes one message a frame; it opens no socket and reads no clock. The first packet of
//! each message is Start of Frame, in every mode. The image generator begins in standby, in which only the mode of IG
//! Control counts; when a host orders it, everything returns to its default.

use std::collections::BTreeMap;
use std::fmt;

use crate::answer;
use crate::notes::Notes;
use crate::site::Site;
use crate::state::State;
use crate::wire::{
    Direction, EnvironmentalConditionsRequest, Family, Fault, HatHotRequest, IgControl, Message, Order, Packet, Placed,
    StartOfFrame, Version, Writer, maritime,
};
use crate::world::{Loading, World};

/// Most requests of each kind that wait for an answer. More are counted and not answered.
const MAX_REQUESTS: usize = 256;

/// Mode of the image generator.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// Sends Start of Frame and takes nothing but the mode.
    #[default]
    Standby,
    /// At work.
    Operate,
    /// At work, with a person who looks for faults.
    Debug,
}

impl fmt::Display for Mode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Standby => "standby",
            Self::Operate => "operate",
            Self::Debug => "debug",
        })
    }
}

/// A database that the host asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Database {
    number: u8,
    state: Loading,
    /// Whether the host has answered the negative number by 0, and so knows that loading began.
    is_seen: bool,
}

/// The exchange with one host.
#[derive(Clone, Debug)]
pub struct Session {
    site: Site,
    state: State,
    notes: Notes,
    peer: (Version, Order),
    has_peer: bool,
    mode: Mode,
    database: Option<Database>,
    asked_database: i8,
    ig_frame_number: u32,
    host_frame_number: u32,
    environment_requests: Vec<EnvironmentalConditionsRequest>,
    /// Requests for heights by their number, with the frame in which they came.
    height_requests: BTreeMap<u16, (HatHotRequest, u32)>,
    writer: Writer,
}

impl Session {
    /// Creates a session in standby. Until the host's first message shows its own, messages have this version and byte
    /// order.
    pub fn new(site: Site, version: Version, order: Order) -> Self {
        Self {
            site,
            state: State::default(),
            notes: Notes::default(),
            peer: (version, order),
            has_peer: false,
            mode: Mode::Standby,
            database: None,
            asked_database: 0,
            ig_frame_number: 0,
            host_frame_number: 0,
            environment_requests: Vec::new(),
            height_requests: BTreeMap::new(),
            writer: Writer::new(version, order),
        }
    }

    /// Returns what the host has said and still holds.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Returns the site's table.
    pub fn site(&self) -> &Site {
        &self.site
    }

    /// Returns what was counted.
    pub fn notes(&self) -> &Notes {
        &self.notes
    }

    /// Returns the mode.
    pub fn mode(&self) -> Mode {
        self.mode
    }

    /// Returns the version and byte order of the host; `None` before its first message.
    pub fn peer(&self) -> Option<(Version, Order)> {
        self.has_peer.then_some(self.peer)
    }

    /// Returns the number of the host's last message.
    pub fn host_frame_number(&self) -> u32 {
        self.host_frame_number
    }

    /// Takes a datagram from the host. A good message may have another version or byte order than the last one. Packets
    /// with faults are counted and left out.
    ///
    /// # Errors
    /// A datagram that does not begin with a good IG Control, which is counted and changes nothing else.
    pub fn receive(&mut self, datagram: &[u8]) -> Result<(), Fault> {
        let opened = Message::open(datagram).and_then(|message| Ok((message, first_packet(&message)?)));
        let (message, first) = opened.inspect_err(|fault| self.notes.add_fault(fault))?;
        self.peer = (message.version, message.order);
        self.has_peer = true;
        self.host_frame_number = first.host_frame_number;
        self.set_mode(first.ig_mode);
        if self.mode == Mode::Standby {
            return Ok(());
        }
        self.ask_database(first.database_number);
        for placed in message.packets() {
            match placed {
                Ok(placed) => self.take(&placed, &message),
                Err(fault) => self.notes.add_fault(&fault),
            }
        }
        Ok(())
    }

    fn set_mode(&mut self, number: u8) {
        let wanted = match number {
            0 => Mode::Standby,
            1 => Mode::Operate,
            2 => Mode::Debug,
            _ => {
                self.notes.add(
                    IgControl::LAYOUT.name,
                    "ig_mode",
                    "ignored, only the image generator may choose mode 3",
                );
                return;
            }
        };
        if wanted == Mode::Standby && self.mode != Mode::Standby {
            self.state = State::default();
            self.environment_requests.clear();
            self.height_requests.clear();
        }
        self.mode = wanted;
    }

    fn ask_database(&mut self, number: i8) {
        let is_new = number != self.asked_database;
        self.asked_database = number;
        match u8::try_from(number) {
            Ok(0) => {
                if let Some(database) = &mut self.database {
                    database.is_seen = true;
                }
            }
            Ok(number) if is_new => {
                self.database = Some(Database { number, state: Loading::Underway, is_seen: false });
            }
            Ok(_) => {}
            Err(_) => self.notes.add(IgControl::LAYOUT.name, "database_number", "ignored, must be in [0, 127]"),
        }
    }

    fn take(&mut self, placed: &Placed<'_>, message: &Message<'_>) {
        let family = message.version.family();
        let Some(packet) = placed.packet else {
            self.notes.add(Packet::other_name(family, placed.id), "", "ignored, this program has no use for it");
            return;
        };
        match packet {
            Packet::EnvironmentalConditionsRequest(request) => {
                if self.environment_requests.len() < MAX_REQUESTS {
                    self.environment_requests.push(request);
                } else {
                    self.notes.add(packet.layout().name, "", "not answered, too many requests in one frame");
                }
            }
            Packet::HatHotRequest(request) => {
                let has_room = self.height_requests.len() < MAX_REQUESTS;
                if has_room || self.height_requests.contains_key(&request.hat_hot_id) {
                    self.height_requests.insert(request.hat_hot_id, (request, self.ig_frame_number));
                } else {
                    self.notes.add(packet.layout().name, "", "not answered, too many requests at a time");
                }
            }
            Packet::MaritimeSurfaceConditionsControl(mut sea) if self.site.reads_early_ids => {
                let is_known = |id: u16| match sea.scope {
                    1 => self.state.regions.contains_key(&id),
                    2 => self.state.entities.contains_key(&id),
                    _ => true,
                };
                sea.entity_or_region_id =
                    maritime::meant_id(&sea, placed.bytes, message.version, message.order, is_known);
                self.state.apply(&sea.into(), family, &mut self.notes);
            }
            _ if is_answer(&packet) => {
                self.notes.add(packet.layout().name, "", "ignored, it is an image generator's own");
            }
            _ => self.state.apply(&packet, family, &mut self.notes),
        }
    }

    /// Makes the message of one frame: Start of Frame, then the answers to all requests since the last frame.
    /// `timestamp_10us` is the time, ticks of 10 us.
    pub fn frame(&mut self, timestamp_10us: u32, world: &mut dyn World) -> &[u8] {
        self.ig_frame_number = self.ig_frame_number.wrapping_add(1);
        if self.mode != Mode::Standby
            && let Some(database) = &mut self.database
            && database.state == Loading::Underway
        {
            database.state = world.load(database.number);
        }
        let (version, order) = self.peer;
        self.writer.restart(version, order);
        let mut answers = vec![self.start_of_frame(timestamp_10us)];
        if self.mode != Mode::Standby {
            let sea_level_m = self.site.sea_level_m();
            for request in self.environment_requests.drain(..) {
                answers.extend(answer::environment(&request, &self.state, sea_level_m, &mut self.notes));
            }
            answers.extend(self.heights(world));
        }
        for packet in answers {
            if let Err(fault) = self.writer.push(packet) {
                self.notes.add_fault(&fault);
                break;
            }
        }
        self.writer.bytes()
    }

    fn start_of_frame(&self, timestamp_10us: u32) -> Packet {
        StartOfFrame {
            database_number: self.database_number(),
            ig_mode: match self.mode {
                Mode::Standby => 0,
                Mode::Operate => 1,
                Mode::Debug => 2,
            },
            timestamp_valid: true,
            ig_frame_number: self.ig_frame_number,
            timestamp_10us,
            last_host_frame_number: self.host_frame_number,
            ..StartOfFrame::default()
        }
        .into()
    }

    /// Returns what Start of Frame says of the database: minus its number until it is loaded and the host knows that
    /// loading began.
    fn database_number(&self) -> i8 {
        let Some(database) = self.database else { return 0 };
        let number = database.number as i8;
        match database.state {
            Loading::Failed => i8::MIN,
            Loading::Ready if database.is_seen => number,
            Loading::Ready | Loading::Underway => -number,
        }
    }

    /// Answers the requests for heights that are due, and forgets those that ask for one answer.
    fn heights(&mut self, world: &mut dyn World) -> Vec<Packet> {
        let now = self.ig_frame_number;
        let is_due = |request: &HatHotRequest, came: u32| {
            let period = u32::from(request.update_period);
            period == 0 || now.wrapping_sub(came).wrapping_sub(1).is_multiple_of(period)
        };
        let due: Vec<HatHotRequest> = self
            .height_requests
            .values()
            .filter(|(request, came)| is_due(request, *came))
            .map(|(request, _)| *request)
            .collect();
        self.height_requests.retain(|_, (request, _)| request.update_period != 0);
        let (state, frame, notes) = (&self.state, self.host_frame_number, &mut self.notes);
        due.iter().map(|request| answer::height(request, state, frame, world, notes)).collect()
    }
}

/// Returns the first packet of a message from the host.
fn first_packet(message: &Message<'_>) -> Result<IgControl, Fault> {
    if message.direction == Direction::ToHost {
        return Err(Fault::Misplaced { name: StartOfFrame::LAYOUT.name });
    }
    match message.packets().next() {
        Some(Ok(Placed { packet: Some(Packet::IgControl(first)), .. })) => Ok(first),
        Some(Err(fault)) => Err(fault),
        _ => Err(Fault::NotCigi),
    }
}

/// Whether a packet is one that image generators send.
fn is_answer(packet: &Packet) -> bool {
    let header = packet.layout().header(Family::V3);
    header.is_some_and(|header| header.id > 100)
}
