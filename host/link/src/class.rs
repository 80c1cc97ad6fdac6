//! What an error means to whoever called: three classes, whatever the kind of link.

/// Whose an error is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// The call was wrong: another target or another option is needed.
    Call,
    /// The station: a cable, a port, a right, a program.
    Station,
    /// Somebody else has what is needed.
    Busy,
}
