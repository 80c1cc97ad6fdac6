//! Misconduct with packets, against the wire's rules.

/// What a board wrongly does with packets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Conduct {
    /// It carries them out whichever session they name.
    AnySession,
    /// It lets another host take it, whoever holds it.
    NeverHeld,
    /// It keeps the counters of the previous session.
    CountersKept,
    /// It restarts the count of ROW_OUT packets after a RESET.
    PacketsAnew,
    /// It takes rows in any place of their frame.
    RowsAnywhere,
    /// It frees every output bank on a ROW_ACK, whichever rows that names.
    GreedyAck,
    /// It frees every output bank on a packet whose CRC is wrong.
    DamagedAck,
    /// It says of every row that is sent again that it was never sent before.
    StuckRepeats,
}
