//! The first row of a burst whose signature differs from the expected one.

/// A trapped row.
#[derive(Debug)]
pub(crate) struct Trapped {
    /// The number of the frame in the burst.
    pub(crate) frame: u32,
    /// The row's number, as counted when it left.
    pub(crate) row: u16,
    /// Its signature.
    pub(crate) signature: u32,
    /// Its samples.
    pub(crate) samples: Vec<u16>,
}

/// The trap.
#[derive(Debug)]
pub(super) struct Trap {
    pub(super) is_set: bool,
    /// The expected signature of each row; 0 where none was uploaded.
    pub(super) expected: Vec<u32>,
    pub(super) kept: Option<Trapped>,
}

impl Trap {
    pub(super) fn new(max_height: u16) -> Self {
        Self { is_set: false, expected: vec![0; max_height.into()], kept: None }
    }

    /// Checks a row that has left, and keeps it if it is the first wrong one.
    pub(super) fn look(&mut self, frame: u32, row: u16, signature: u32, samples: &[[u8; 2]]) {
        if self.is_set
            && self.kept.is_none()
            && self.expected.get(usize::from(row)).is_some_and(|&expected| expected != signature)
        {
            let samples = samples.iter().copied().map(u16::from_le_bytes).collect();
            self.kept = Some(Trapped { frame, row, signature, samples });
        }
    }
}
