//! The process's table of live objects. A handle is pointer-typed for C's type checks, but it is a number: kind,
//! generation, slot. It is never dereferenced, so a stale, foreign or wrong handle gives an error instead of a crash.

use std::{
    any::Any,
    sync::{Arc, PoisonError, RwLock, RwLockReadGuard, RwLockWriteGuard},
};

use super::device_cell::DeviceCell;
use crate::error::{Error, Result, Status};

/// Object behind a C handle type.
pub(in crate::capi) trait HandleObject: Any + Send + Sync {
    /// Opaque type in the header.
    type C;
    /// Number of the kind, 1 to 15, different for every kind.
    const KIND: u8;
    /// Name of the opaque type in the header.
    const NAME: &'static str;
    /// Returns the device on which the object's GPU resources live; `None` for objects without any.
    fn device(&self) -> Option<&Arc<DeviceCell>>;
}

/// Place for one object in the table.
struct HandleSlot {
    generation: u32,
    kind: u8,
    name: &'static str,
    /// Number of live objects whose parent is the object of this slot.
    children: u32,
    /// Slot of the parent.
    parent: Option<usize>,
    object: Option<Arc<dyn Any + Send + Sync>>,
}

/// All slots, and the indices of the free ones.
#[derive(Default)]
struct HandleTable {
    slots: Vec<HandleSlot>,
    free: Vec<usize>,
}

static TABLE: RwLock<HandleTable> = RwLock::new(HandleTable { slots: Vec::new(), free: Vec::new() });

/// Bit layout of a handle, from the lowest bit up: one set bit (so it is never NULL and never an aligned address),
/// slot, generation, kind. A slot whose generations are used up is never used again, so no handle is ever issued twice.
const SLOT_BITS: u32 = if usize::BITS == 64 { 24 } else { 15 };
const GENERATION_BITS: u32 = if usize::BITS == 64 { 31 } else { 12 };
const GENERATION_SHIFT: u32 = 1 + SLOT_BITS;
const KIND_SHIFT: u32 = GENERATION_SHIFT + GENERATION_BITS;

/// Returns the handle of a kind, a generation and a slot.
fn encode(kind: u8, generation: u32, slot: usize) -> usize {
    (usize::from(kind) << KIND_SHIFT) | ((generation as usize) << GENERATION_SHIFT) | (slot << 1) | 1
}

/// Returns a number whose lowest `bits` bits are set.
fn mask(bits: u32) -> usize {
    (1 << bits) - 1
}

fn slot_of(handle: usize) -> usize {
    (handle >> 1) & mask(SLOT_BITS)
}

fn read() -> RwLockReadGuard<'static, HandleTable> {
    // No code panics while it holds the table, so the table behind a poisoned lock is still consistent.
    TABLE.read().unwrap_or_else(PoisonError::into_inner)
}

fn write() -> RwLockWriteGuard<'static, HandleTable> {
    TABLE.write().unwrap_or_else(PoisonError::into_inner)
}

/// Returns the slot of a live handle, or an error that says what is wrong with the handle.
fn locate<T: HandleObject>(table: &HandleTable, param: &str, handle: usize) -> Result<usize> {
    let bad = |got: &str| Err(Error::about(Status::BadHandle, param, format!("must be a live {}, got {got}", T::NAME)));
    if handle == 0 {
        return bad("NULL");
    }
    let slot = table.slots.get(slot_of(handle)).filter(|_| handle & 1 == 1);
    let live = slot.filter(|s| s.object.is_some() && encode(s.kind, s.generation, slot_of(handle)) == handle);
    match live {
        Some(s) if s.kind == T::KIND => Ok(slot_of(handle)),
        Some(s) => bad(&format!("a {}", s.name)),
        None => bad(&format!("{handle:#x}, which is destroyed or foreign")),
    }
}

/// Enters a new object into the table, and returns its handle. Until its removal, the object is one of the children of
/// `parent`.
///
/// # Errors
/// [`Status::OutOfMemory`] when the table is full, [`Status::BadHandle`] if the parent was destroyed meanwhile.
pub(in crate::capi) fn insert<T: HandleObject, P: HandleObject>(
    object: Arc<T>,
    parent: Option<*const P::C>,
) -> Result<*mut T::C> {
    let mut table = write();
    let parent = parent.map(|p| locate::<P>(&table, "parent", p as usize)).transpose()?;
    let index = match table.free.pop() {
        Some(index) => index,
        None if table.slots.len() <= mask(SLOT_BITS) => {
            table.slots.push(HandleSlot { generation: 0, kind: 0, name: "", children: 0, parent: None, object: None });
            table.slots.len() - 1
        }
        None => return Err(Error::new(Status::OutOfMemory, "no more handles can be issued in this process")),
    };
    if let Some(parent) = parent {
        table.slots[parent].children += 1;
    }
    let slot = &mut table.slots[index];
    *slot = HandleSlot {
        generation: slot.generation,
        kind: T::KIND,
        name: T::NAME,
        children: 0,
        parent,
        object: Some(object),
    };
    Ok(encode(T::KIND, slot.generation, index) as *mut T::C)
}

/// Returns the live object of a handle.
///
/// # Errors
/// [`Status::BadHandle`] naming the parameter and what was found instead.
pub(in crate::capi) fn get<T: HandleObject>(param: &str, handle: *const T::C) -> Result<Arc<T>> {
    let table = read();
    let slot = locate::<T>(&table, param, handle as usize)?;
    let object = table.slots[slot].object.clone().map(|o| o.downcast::<T>());
    drop(table);
    match object {
        Some(Ok(object)) => Ok(object),
        _ => Err(Error::new(Status::Internal, format!("the handle table is wrong about {param}"))),
    }
}

/// Removes an object from the table; its handle is dead from here on.
///
/// # Errors
/// [`Status::BadHandle`]; [`Status::InUse`] while it has children.
pub(in crate::capi) fn remove<T: HandleObject>(param: &str, handle: *const T::C) -> Result<Arc<T>> {
    let mut table = write();
    let index = locate::<T>(&table, param, handle as usize)?;
    let children = table.slots[index].children;
    if children > 0 {
        let noun = if children == 1 { "child" } else { "children" };
        let rest = format!("has {children} live {noun} (contexts, views, surfaces, textures): destroy first");
        return Err(Error::about(Status::InUse, param, rest));
    }
    let slot = &mut table.slots[index];
    let (object, parent) = (slot.object.take(), slot.parent.take());
    let reusable = (slot.generation as usize) < mask(GENERATION_BITS);
    slot.generation += u32::from(reusable);
    if let Some(parent) = parent {
        table.slots[parent].children -= 1;
    }
    if reusable {
        table.free.push(index);
    }
    drop(table);
    match object.map(|o| o.downcast::<T>()) {
        Some(Ok(object)) => Ok(object),
        _ => Err(Error::new(Status::Internal, format!("the handle table is wrong about {param}"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Ship;
    struct Boat;
    struct CShip;
    struct CBoat;

    impl HandleObject for Ship {
        type C = CShip;
        const KIND: u8 = 14;
        const NAME: &'static str = "wk_ship";
        fn device(&self) -> Option<&Arc<DeviceCell>> {
            None
        }
    }

    impl HandleObject for Boat {
        type C = CBoat;
        const KIND: u8 = 15;
        const NAME: &'static str = "wk_boat";
        fn device(&self) -> Option<&Arc<DeviceCell>> {
            None
        }
    }

    #[test]
    fn stale_foreign_and_wrong_handles_are_distinguished() {
        let ship = insert::<Ship, Ship>(Arc::new(Ship), None).unwrap();
        assert!(get::<Ship>("ship", ship).is_ok());
        let wrong = get::<Boat>("boat", ship.cast()).err().unwrap();
        assert_eq!((wrong.status, wrong.to_string().contains("got a wk_ship")), (Status::BadHandle, true));
        assert!(get::<Ship>("ship", std::ptr::null()).err().unwrap().to_string().contains("NULL"));
        let on_stack = 0_u64;
        assert!(get::<Ship>("ship", (&raw const on_stack).cast()).is_err());
        assert!(get::<Ship>("ship", usize::MAX as *const CShip).is_err());
        remove::<Ship>("ship", ship).unwrap();
        assert!(get::<Ship>("ship", ship).err().unwrap().to_string().contains("destroyed or foreign"));
        let again = insert::<Ship, Ship>(Arc::new(Ship), None).unwrap();
        assert_ne!(ship, again, "a slot's next handle differs from the dead one");
        assert!(get::<Ship>("ship", ship).is_err());
        remove::<Ship>("ship", again).unwrap();
    }

    #[test]
    fn a_parent_with_live_children_is_not_removed() {
        let ship = insert::<Ship, Ship>(Arc::new(Ship), None).unwrap();
        let boat = insert::<Boat, Ship>(Arc::new(Boat), Some(ship)).unwrap();
        assert_eq!(remove::<Ship>("ship", ship).err().unwrap().status, Status::InUse);
        remove::<Boat>("boat", boat).unwrap();
        remove::<Ship>("ship", ship).unwrap();
        assert!(insert::<Boat, Ship>(Arc::new(Boat), Some(ship)).is_err(), "a dead parent takes no children");
    }

    #[test]
    fn handles_of_many_threads_never_share_a_slot() {
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| {
                    for _ in 0..2000 {
                        let ship = insert::<Ship, Ship>(Arc::new(Ship), None).unwrap();
                        assert!(get::<Ship>("ship", ship).is_ok());
                        remove::<Ship>("ship", ship).unwrap();
                        assert!(get::<Ship>("ship", ship).is_err());
                    }
                });
            }
        });
    }
}
