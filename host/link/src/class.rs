//! What an error means to the caller: three classes, whatever the kind of link.

/// Who can do something about an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// The call was wrong: another target or another option is needed.
    Call,
    /// Something at the station is wrong: a cable, a port, a permission, a program.
    Station,
    /// Another program or host has what is needed.
    Busy,
}
