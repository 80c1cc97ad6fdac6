//! What a board can do with packets that the wire does not have.

/// What a board does with packets that it must not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Conduct {
    /// It carries them out whatever session they name.
    AnySession,
    /// It is taken by another host whoever holds it.
    NeverHeld,
    /// It goes on with the counters of the session before.
    CountersKept,
    /// It begins the count of ROW_OUT packets anew behind a RESET.
    PacketsAnew,
    /// It takes rows in any place of their frame.
    RowsAnywhere,
    /// It frees every output bank at a ROW_ACK, whatever rows that names.
    GreedyAck,
    /// It frees every output bank at a packet whose CRC is wrong.
    DamagedAck,
    /// It says of each row that is sent again that it was never sent before.
    StuckRepeats,
}
