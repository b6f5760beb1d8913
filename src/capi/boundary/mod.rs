//! Lower floor of the C boundary: what all `wk_*` calls share. It contains no `wk_*` call itself.
//!
//! A call runs inside [`guard`], which stops panics and keeps the thread's last error (`call`). It finds its objects by
//! their handles (`handles`, `objects`). Each object holds the cell of its device (`device_cell`), which knows the
//! device's owner (`owner`). The call checks its parameters (`input`), and reads and writes structs of any version
//! (`layout`). `numbers` has the statuses and struct types, and `log_sink` has the host's log callback.

pub(in crate::capi) mod call;
mod device_cell;
pub(in crate::capi) mod handles;
pub(in crate::capi) mod input;
pub(in crate::capi) mod layout;
pub(in crate::capi) mod log_sink;
pub(in crate::capi) mod numbers;
pub(in crate::capi) mod objects;
mod owner;

pub(in crate::capi) use call::{Call, guard};
pub(in crate::capi) use device_cell::DeviceCell;
pub(in crate::capi) use owner::Host;
