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
    /// It writes the factors or grid entries in front of one that it refuses.
    PartialWrite,
    /// It names a wrong entry by its place in the packet instead of that in the table.
    PlaceInPacket,
    /// It refuses a ROW_ACK of another session.
    AckRefused,
    /// It takes any row behind one that waits, as if that had not come.
    AnyFollower,
    /// It takes rows as acknowledged that it has not sent yet.
    AckBeyond,
    /// It counts the close of a session as a session.
    CountedClose,
    /// It does not send the zero behind a piece of 254 bytes.
    ZeroUnsent,
    /// It does not read the zero behind a piece of 254 bytes.
    ZeroUnread,
    /// It names 16 bits of its window.
    ShortWindow,
    /// It goes on with the gaps of the frame before, instead of beginning with the seed.
    GapsGoOn,
    /// It refuses a read that is too long without naming the first entry.
    UnnamedRead,
}

impl Conduct {
    /// Those that break a rule which a run must try on purpose, by their names.
    pub(crate) const UNKEPT: [(&str, Self); 11] = [
        ("partial-write", Self::PartialWrite),
        ("place-in-packet", Self::PlaceInPacket),
        ("ack-refused", Self::AckRefused),
        ("any-follower", Self::AnyFollower),
        ("ack-beyond", Self::AckBeyond),
        ("counted-close", Self::CountedClose),
        ("zero-unsent", Self::ZeroUnsent),
        ("zero-unread", Self::ZeroUnread),
        ("short-window", Self::ShortWindow),
        ("gaps-go-on", Self::GapsGoOn),
        ("unnamed-read", Self::UnnamedRead),
    ];

    /// The names alone, in the order of [`Self::UNKEPT`].
    pub(crate) const UNKEPT_NAMES: [&str; Self::UNKEPT.len()] = {
        let mut names = [""; Self::UNKEPT.len()];
        let mut place = 0;
        while place < names.len() {
            names[place] = Self::UNKEPT[place].0;
            place += 1;
        }
        names
    };
}
