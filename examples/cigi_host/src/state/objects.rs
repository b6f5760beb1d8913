//! Entities with their parts, views, and components.

use std::collections::BTreeMap;

use super::{MAX_COMPONENTS, MAX_ENTITIES, MAX_ITEMS, MAX_VIEWS, Scope, State, entry};
use crate::geodesy::{Attitude, Place, Pose};
use crate::notes::{Checked, Notes};
use crate::wire::{
    ArticulatedPartControl, ComponentControl, EntityControl, EntityPosition, Family, RateControl,
    ShortArticulatedPartControl, ShortComponentControl, ViewControl, ViewDefinition,
};

/// Angles of any object; more turns are of no use.
const ANGLE_DEG: [f64; 2] = [-720.0, 720.0];
/// Offsets in a parent's axes.
const OFFSET_M: [f64; 2] = [-1e7, 1e7];
/// Most parents of a child, which also ends a circle of parents.
const MAX_DEPTH: usize = 16;

/// Velocities of an entity or of its part.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rates {
    /// Whether they are along the object's own axes.
    pub is_local: bool,
    /// Velocity along the three axes, m/s.
    pub velocity_mps: [f64; 3],
    /// Roll, pitch and yaw a second, degrees.
    pub roll_pitch_yaw_dps: [f64; 3],
}

/// A part of an entity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Part {
    /// Whether it is shown.
    pub is_shown: bool,
    /// Offset forward, right and down, m; then roll, pitch and yaw, degrees.
    pub freedoms: [f64; 6],
    /// Velocities; `None` if it rests.
    pub rates: Option<Rates>,
}

/// An entity.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Entity {
    /// Whether it is shown; else it stands by.
    pub is_active: bool,
    /// Type of the image generator's list, or the country of an extended type.
    pub entity_type: u16,
    /// The other fields of an extended type: kind, domain, category, subcategory, specific, extra.
    pub extended_type: Option<[u8; 6]>,
    /// 0 clear to 255 opaque.
    pub alpha: u8,
    /// Parent of a child.
    pub parent: Option<u16>,
    /// Place of an entity at the top level.
    pub place: Place,
    /// Offset of a child in its parent's axes: forward, right, down, m.
    pub offset_m: [f64; 3],
    /// Yaw, pitch and roll, degrees.
    pub yaw_pitch_roll_deg: [f64; 3],
    /// 0 none, 1 altitude to the ground, 2 altitude and attitude.
    pub clamp: u8,
    /// Velocities; `None` if it rests.
    pub rates: Option<Rates>,
    /// Parts by their number.
    pub parts: BTreeMap<u8, Part>,
    /// Its environment. Weather has the layer number 0.
    pub scope: Scope,
}

/// Half angles of a frustum and its planes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frustum {
    /// Distance of the near plane, m.
    pub near_m: f64,
    /// Distance of the far plane, m.
    pub far_m: f64,
    /// Half angles to the left, right, top and bottom, degrees; left and bottom are negative by custom.
    pub left_right_top_bottom_deg: [f64; 4],
}

impl Default for Frustum {
    fn default() -> Self {
        Self { near_m: 1.0, far_m: 1e5, left_right_top_bottom_deg: [-30.0, 30.0, 20.0, -20.0] }
    }
}

/// A view.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct View {
    /// Group that it belongs to; 0 for none.
    pub group: u8,
    /// Entity that carries it.
    pub entity: u16,
    /// Offset in the entity's axes: forward, right, down, m; then roll, pitch and yaw, degrees.
    pub freedoms: [f64; 6],
    /// Its frustum.
    pub frustum: Frustum,
    /// Whether the projection is orthographic.
    pub is_orthographic: bool,
    /// 0 none, 1 horizontal, 2 vertical, 3 both.
    pub mirror_mode: u8,
    /// 0 none, 1 1x2, 2 2x1, 3 2x2.
    pub pixel_replication: u8,
    /// Type of the image generator's own list.
    pub view_type: u8,
}

/// Class, object and number of a component.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ComponentKey {
    /// Class, as in [`ComponentControl`].
    pub class: u8,
    /// Object, by class.
    pub instance: u16,
    /// Component.
    pub component: u16,
}

/// Last command to a component.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Component {
    /// State.
    pub state: u8,
    /// Six words of data; a short command has two.
    pub data: [u32; 6],
}

/// Takes those of six values whose bits are set.
fn take_bits(values: &mut [f64; 6], given: [f32; 6], bits: u8, names: [&'static str; 6], checked: &mut Checked<'_>) {
    for i in (0..6).filter(|i| bits & 1 << i != 0) {
        let range = if i < 3 { OFFSET_M } else { ANGLE_DEG };
        values[i] = checked.number(names[i], given[i], values[i], range);
    }
}

const FREEDOMS: [&str; 6] = ["x_offset_m", "y_offset_m", "z_offset_m", "roll_deg", "pitch_deg", "yaw_deg"];

impl State {
    /// Takes the state of an entity, and in 3.x its place.
    pub(super) fn control_entity(&mut self, packet: &EntityControl, family: Family, notes: &mut Notes) {
        let id = packet.entity_id;
        if packet.entity_state >= 2 {
            self.remove_entity(id);
            return;
        }
        let Some(entity) = entry(&mut self.entities, id, MAX_ENTITIES, EntityControl::LAYOUT.name, notes) else {
            return;
        };
        entity.is_active = packet.entity_state == 1;
        entity.entity_type = packet.entity_type;
        entity.alpha = packet.alpha;
        let EntityControl { kind, domain, category, subcategory, specific, extra, .. } = *packet;
        entity.extended_type = packet.extended_type.then_some([kind, domain, category, subcategory, specific, extra]);
        if family == Family::V3 {
            let position = EntityPosition {
                entity_id: id,
                attach_state: packet.attach_state,
                parent_id: packet.parent_id,
                clamp: packet.clamp,
                roll_deg: packet.roll_deg,
                pitch_deg: packet.pitch_deg,
                yaw_deg: packet.yaw_deg,
                latitude_deg: packet.latitude_deg,
                longitude_deg: packet.longitude_deg,
                altitude_m: packet.altitude_m,
                x_offset_m: packet.x_offset_m,
                y_offset_m: packet.y_offset_m,
                z_offset_m: packet.z_offset_m,
            };
            self.place_entity(&position, notes);
        }
    }

    pub(super) fn place_entity(&mut self, packet: &EntityPosition, notes: &mut Notes) {
        const NAME: &str = EntityPosition::LAYOUT.name;
        let Some(entity) = self.entities.get_mut(&packet.entity_id) else {
            notes.add(NAME, "entity_id", "ignored, there is no such entity");
            return;
        };
        let mut checked = Checked { notes, packet: NAME };
        let mut number = |field, value: f64, former, range| checked.number(field, value, former, range);
        entity.clamp = packet.clamp;
        if packet.attach_state == 0 {
            entity.parent = None;
            let former = entity.place;
            entity.place = Place {
                latitude_deg: number("latitude_deg", packet.latitude_deg, former.latitude_deg, [-90.0, 90.0]),
                longitude_deg: number("longitude_deg", packet.longitude_deg, former.longitude_deg, [-360.0, 360.0]),
                altitude_m: number("altitude_m", packet.altitude_m, former.altitude_m, OFFSET_M),
            };
        } else {
            entity.parent = Some(packet.parent_id);
            let given = [packet.x_offset_m, packet.y_offset_m, packet.z_offset_m];
            for (i, value) in given.into_iter().enumerate() {
                entity.offset_m[i] = number(FREEDOMS[i], value, entity.offset_m[i], OFFSET_M);
            }
        }
        let angles = [("yaw_deg", packet.yaw_deg), ("pitch_deg", packet.pitch_deg), ("roll_deg", packet.roll_deg)];
        for (former, (field, value)) in entity.yaw_pitch_roll_deg.iter_mut().zip(angles) {
            *former = number(field, value.into(), *former, ANGLE_DEG);
        }
    }

    /// Removes an entity with all its children.
    fn remove_entity(&mut self, id: u16) {
        let mut gone = vec![id];
        while let Some(id) = gone.pop() {
            if self.entities.remove(&id).is_some() {
                gone.extend(self.entities.iter().filter(|(_, e)| e.parent == Some(id)).map(|(child, _)| *child));
            }
        }
    }

    pub(super) fn place_view(&mut self, packet: &ViewControl, notes: &mut Notes) {
        const NAME: &str = ViewControl::LAYOUT.name;
        let given = [
            packet.x_offset_m,
            packet.y_offset_m,
            packet.z_offset_m,
            packet.roll_deg,
            packet.pitch_deg,
            packet.yaw_deg,
        ];
        let place = |view: &mut View, notes: &mut Notes| {
            view.entity = packet.entity_id;
            take_bits(&mut view.freedoms, given, packet.enable_bits, FREEDOMS, &mut Checked { notes, packet: NAME });
        };
        if packet.group_id == 0 {
            if let Some(view) = entry(&mut self.views, packet.view_id, MAX_VIEWS, NAME, notes) {
                place(view, notes);
            }
        } else {
            self.views.values_mut().filter(|v| v.group == packet.group_id).for_each(|view| place(view, notes));
        }
    }

    pub(super) fn define_view(&mut self, packet: &ViewDefinition, notes: &mut Notes) {
        const NAME: &str = ViewDefinition::LAYOUT.name;
        const ANGLES: [&str; 4] = ["left_deg", "right_deg", "top_deg", "bottom_deg"];
        let Some(view) = entry(&mut self.views, packet.view_id, MAX_VIEWS, NAME, notes) else { return };
        let mut checked = Checked { notes, packet: NAME };
        let has = |bit: u8| packet.enable_bits & 1 << bit != 0;
        let frustum = &mut view.frustum;
        if has(0) {
            frustum.near_m = checked.number("near_m", packet.near_m, frustum.near_m, [1e-3, 1e7]);
        }
        if has(1) {
            frustum.far_m = checked.number("far_m", packet.far_m, frustum.far_m, [1e-2, 1e9]);
        }
        let given = [packet.left_deg, packet.right_deg, packet.top_deg, packet.bottom_deg];
        for (i, angle) in frustum.left_right_top_bottom_deg.iter_mut().enumerate().filter(|(i, _)| has(*i as u8 + 2)) {
            *angle = checked.number(ANGLES[i], given[i], *angle, [-90.0, 90.0]);
        }
        view.group = packet.group_id;
        view.is_orthographic = packet.projection_type != 0;
        view.mirror_mode = packet.mirror_mode;
        view.pixel_replication = packet.pixel_replication;
        view.view_type = packet.view_type;
    }

    pub(super) fn control_component(&mut self, packet: &ComponentControl, notes: &mut Notes) {
        let ComponentControl { component_class, instance_id, component_id, .. } = *packet;
        let key = ComponentKey { class: component_class, instance: instance_id, component: component_id };
        let ComponentControl { data1_as_u32, data2, data3, data4, data5, .. } = *packet;
        let data = [packet.data0_as_f32.to_bits(), data1_as_u32, data2, data3, data4, data5];
        let name = ComponentControl::LAYOUT.name;
        if let Some(component) = entry(&mut self.components, key, MAX_COMPONENTS, name, notes) {
            *component = Component { state: packet.component_state, data };
        }
    }

    pub(super) fn control_short_component(&mut self, packet: &ShortComponentControl, notes: &mut Notes) {
        let ShortComponentControl { component_class, instance_id, component_id, component_state, .. } = *packet;
        let (data0_as_f32, data1_as_u32) = (packet.data0_as_f32, packet.data1_as_u32);
        self.control_component(
            &ComponentControl {
                component_class,
                instance_id,
                component_id,
                component_state,
                data0_as_f32,
                data1_as_u32,
                ..ComponentControl::default()
            },
            notes,
        );
    }

    fn part(&mut self, entity: u16, part: u8, name: &'static str, notes: &mut Notes) -> Option<&mut Part> {
        let Some(entity) = self.entities.get_mut(&entity) else {
            notes.add(name, "entity_id", "ignored, there is no such entity");
            return None;
        };
        entry(&mut entity.parts, part, MAX_ITEMS, name, notes)
    }

    pub(super) fn control_part(&mut self, packet: &ArticulatedPartControl, notes: &mut Notes) {
        const NAME: &str = ArticulatedPartControl::LAYOUT.name;
        let Some(part) = self.part(packet.entity_id, packet.part_id, NAME, notes) else { return };
        let given = [
            packet.x_offset_m,
            packet.y_offset_m,
            packet.z_offset_m,
            packet.roll_deg,
            packet.pitch_deg,
            packet.yaw_deg,
        ];
        part.is_shown = packet.enable_bits & 1 != 0;
        let bits = packet.enable_bits >> 1;
        take_bits(&mut part.freedoms, given, bits, FREEDOMS, &mut Checked { notes, packet: NAME });
    }

    pub(super) fn control_parts(&mut self, packet: &ShortArticulatedPartControl, notes: &mut Notes) {
        const NAME: &str = ShortArticulatedPartControl::LAYOUT.name;
        let both = [
            (packet.part1_id, packet.part1_enable, packet.dof1_select, packet.dof1, "dof1"),
            (packet.part2_id, packet.part2_enable, packet.dof2_select, packet.dof2, "dof2"),
        ];
        for (id, is_shown, select, value, field) in both {
            // 0 is no degree of freedom; 4, 5 and 6 are yaw, pitch and roll.
            let freedom = match select {
                1..=3 => usize::from(select) - 1,
                4..=6 => 9 - usize::from(select),
                _ => continue,
            };
            let Some(part) = self.part(packet.entity_id, id, NAME, notes) else { return };
            part.is_shown = is_shown;
            let range = if freedom < 3 { OFFSET_M } else { ANGLE_DEG };
            let former = part.freedoms[freedom];
            part.freedoms[freedom] = Checked { notes, packet: NAME }.number(field, value, former, range);
        }
    }

    pub(super) fn control_rates(&mut self, packet: &RateControl, notes: &mut Notes) {
        const NAME: &str = RateControl::LAYOUT.name;
        const NAMES: [&str; 6] = ["x_mps", "y_mps", "z_mps", "roll_dps", "pitch_dps", "yaw_dps"];
        let given = [packet.x_mps, packet.y_mps, packet.z_mps, packet.roll_dps, packet.pitch_dps, packet.yaw_dps];
        let target = if packet.apply_to_part {
            self.part(packet.entity_id, packet.part_id, NAME, notes).map(|part| &mut part.rates)
        } else {
            self.entities.get_mut(&packet.entity_id).map(|entity| &mut entity.rates)
        };
        let Some(target) = target else {
            if !packet.apply_to_part {
                notes.add(NAME, "entity_id", "ignored, there is no such entity");
            }
            return;
        };
        let former = target.unwrap_or_default();
        let [a, b, c] = former.velocity_mps;
        let [d, e, f] = former.roll_pitch_yaw_dps;
        let mut values = [a, b, c, d, e, f];
        let mut checked = Checked { notes, packet: NAME };
        for (i, value) in values.iter_mut().enumerate() {
            *value = checked.number(NAMES[i], given[i], *value, [-1e5, 1e5]);
        }
        let [a, b, c, d, e, f] = values;
        let is_local = packet.coordinate_system != 0;
        let rates = Rates { is_local, velocity_mps: [a, b, c], roll_pitch_yaw_dps: [d, e, f] };
        *target = values.iter().any(|value| *value != 0.0).then_some(rates);
    }

    /// Returns where an entity is and how it stands; `None` if it or one of its parents does not exist, or the parents
    /// form a circle.
    pub fn entity_pose(&self, id: u16) -> Option<Pose> {
        let mut chain = Vec::new();
        let mut next = Some(id);
        while let Some(id) = next {
            if chain.len() > MAX_DEPTH {
                return None;
            }
            let entity = self.entities.get(&id)?;
            chain.push(entity);
            next = entity.parent;
        }
        let root = chain.pop()?;
        let first = Pose { place: root.place, attitude: Attitude::of_angles(root.yaw_pitch_roll_deg) };
        Some(chain.iter().rev().fold(first, |pose, child| pose.with_child(child.offset_m, child.yaw_pitch_roll_deg)))
    }

    /// Returns where a view's eye is and how it looks; `None` if it does not exist or its entity has no pose.
    pub fn view_pose(&self, id: u16) -> Option<Pose> {
        let view = self.views.get(&id)?;
        let [x, y, z, roll, pitch, yaw] = view.freedoms;
        Some(self.entity_pose(view.entity)?.with_child([x, y, z], [yaw, pitch, roll]))
    }
}
