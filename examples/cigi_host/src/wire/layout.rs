//! Description of a packet's fields, and the macro that makes a type, its reader and its writer of one table.

use super::slot::{Slot, Value};

/// Family of versions with the same table of offsets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// CIGI 3.0 to 3.3.
    V3,
    /// CIGI 4.0.
    V4,
}

/// When a field counts, and whether the form of JSON that the captures have lists it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Always.
    Listed,
    /// Always, but the captures' JSON leaves it out.
    Unlisted,
    /// Always, but the captures' JSON has it in 4.0 only.
    ListedInV4,
    /// For an object at the top level, or a place in geodetic coordinates.
    Top,
    /// For a child, or a place in an entity's axes.
    Child,
}

/// Field of a packet.
#[derive(Clone, Copy, Debug)]
pub struct Field {
    /// Name, as in JSON.
    pub name: &'static str,
    /// When it counts.
    pub role: Role,
    /// Places in 3.x and in 4.0.
    pub slots: [Slot; 2],
}

impl Field {
    /// Whether the captures' JSON has the field.
    pub fn is_listed(&self, family: Family) -> bool {
        match self.role {
            Role::Unlisted => false,
            Role::ListedInV4 => family == Family::V4,
            Role::Listed | Role::Top | Role::Child => true,
        }
    }

    /// Returns the place in a family of versions.
    pub const fn slot(&self, family: Family) -> Slot {
        self.slots[family as usize]
    }
}

/// Identifier and size of a packet in one family.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Header {
    /// Identifier: 8 bits in 3.x, 16 in 4.0.
    pub id: u16,
    /// Size, bytes.
    pub size: usize,
}

/// Table of one packet.
#[derive(Clone, Copy, Debug)]
pub struct Layout {
    /// Name.
    pub name: &'static str,
    /// Name in 4.0, if it is another one.
    pub v4_name: Option<&'static str>,
    /// Headers in 3.x and in 4.0; `None` if the family has no such packet.
    pub headers: [Option<Header>; 2],
    /// Fields, in the order of JSON.
    pub fields: &'static [Field],
}

impl Layout {
    /// Returns the name in a family of versions, as in JSON.
    pub fn name_in(&self, family: Family) -> &'static str {
        self.v4_name.filter(|_| family == Family::V4).unwrap_or(self.name)
    }

    /// Returns the header in a family of versions.
    pub const fn header(&self, family: Family) -> Option<Header> {
        self.headers[family as usize]
    }
}

/// Returns the last of one or two names.
pub(super) const fn last(names: &[Option<&'static str>]) -> Option<&'static str> {
    names[names.len() - 1]
}

/// Function that is called with each field of a packet and its value.
pub type Visitor<'a> = dyn FnMut(&'static Field, Value) + 'a;

/// Declares packets: for each a struct, and for all [`Packet`](super::Packet). A row of the table is
/// `name: type = place in 3.x, place in 4.0, role`; a packet that can be a child names the field that says so.
macro_rules! packets {
    ($(
        $(#[$meta:meta])*
        $name:ident = $text:literal $(or $v4_text:literal)?, [$v3:expr, $v4:expr] $(, child if $child:ident)? {
            $($(#[$fmeta:meta])* $field:ident: $ty:ty = $s3:expr, $s4:expr, $role:ident;)+
        }
    )+) => {
        $(
            $(#[$meta])*
            #[derive(Clone, Copy, Debug, Default, PartialEq)]
            pub struct $name {
                $($(#[$fmeta])* pub $field: $ty,)+
            }

            impl $name {
                /// Table of the packet.
                pub const LAYOUT: Layout = Layout {
                    name: $text,
                    v4_name: last(&[None $(, Some($v4_text))?]),
                    headers: [$v3, $v4],
                    fields: &[$(Field { name: stringify!($field), role: Role::$role, slots: [$s3, $s4] },)+],
                };

                fn uses(&self, role: Role) -> bool {
                    let is_child = false $(|| self.$child.to_raw() != 0)?;
                    match role {
                        Role::Top => !is_child,
                        Role::Child => is_child,
                        Role::Listed | Role::Unlisted | Role::ListedInV4 => true,
                    }
                }

                fn read(family: Family, bytes: &[u8], order: Order) -> Self {
                    let mut packet = Self::default();
                    $(if packet.uses(Role::$role) {
                        packet.$field = Raw::from_raw([$s3, $s4][family as usize].read(bytes, order));
                    })+
                    packet
                }

                fn write(&self, family: Family, bytes: &mut [u8], order: Order) {
                    $(if self.uses(Role::$role) {
                        [$s3, $s4][family as usize].write(bytes, order, self.$field.to_raw());
                    })+
                }

                fn visit(&self, family: Family, visitor: &mut Visitor<'_>) {
                    let mut fields = Self::LAYOUT.fields.iter();
                    $(if let Some(field) = fields.next()
                        && self.uses(Role::$role)
                        && field.slot(family) != Slot::Absent
                    {
                        visitor(field, self.$field.value());
                    })+
                }
            }

            impl From<$name> for Packet {
                fn from(packet: $name) -> Self {
                    Self::$name(packet)
                }
            }
        )+

        /// A packet of any kind.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum Packet {
            $($(#[$meta])* $name($name),)+
        }

        impl Packet {
            /// Tables of all packets.
            pub const LAYOUTS: &'static [Layout] = &[$($name::LAYOUT,)+];

            /// Returns the table of the packet.
            pub fn layout(&self) -> Layout {
                match self {
                    $(Self::$name(_) => $name::LAYOUT,)+
                }
            }

            /// Reads the packet with this identifier, or `None` if no table has it. Fields beyond the end of `bytes`
            /// read as 0.
            pub fn read(family: Family, id: u16, bytes: &[u8], order: Order) -> Option<Self> {
                $(if $name::LAYOUT.header(family).is_some_and(|header| header.id == id) {
                    return Some(Self::$name($name::read(family, bytes, order)));
                })+
                None
            }

            /// Writes the fields into `bytes`, without the packet's header.
            pub(super) fn write_fields(&self, family: Family, bytes: &mut [u8], order: Order) {
                match self {
                    $(Self::$name(packet) => packet.write(family, bytes, order),)+
                }
            }

            /// Calls `visitor` with each field that the family has and that counts, in the order of JSON.
            pub fn visit(&self, family: Family, visitor: &mut Visitor<'_>) {
                match self {
                    $(Self::$name(packet) => packet.visit(family, visitor),)+
                }
            }
        }
    };
}
pub(super) use packets;
