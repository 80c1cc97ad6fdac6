//! Where in the row an output column comes from.

/// The source coordinate has 37 bits, unsigned; a faulty factor wraps as the register does.
const COORDINATE_MASK: u64 = (1 << 37) - 1;

/// 1.0 as a table entry; the coordinate has one fractional bit more.
const ONE: u64 = 1 << 24;

/// Fractional bits dropped before the kernel's position is formed, and their half.
const DROPPED_BITS: u32 = 12;
const DROPPED_HALF: u64 = 1 << (DROPPED_BITS - 1);

/// Fractional bits of the position: five choose the node, eight interpolate.
pub(crate) const FRACTION_BITS: u32 = 13;

/// The source coordinate S of one output column after the other, in units of 2^-25 column.
#[derive(Debug)]
pub(crate) struct Source {
    coordinate: u64,
    step: u64,
}

/// A source coordinate, rounded to 2^-13 column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Position {
    /// The column at or left of the source, 0 to 4095.
    pub(crate) n: i32,
    /// What lies beyond it, in units of 2^-13 column.
    pub(crate) fraction: u32,
}

impl Source {
    /// S[0] = C·(2^24 − Q), from twice the centre's column and the row's table entry.
    pub(crate) fn new(centre2: u16, factor: u32) -> Self {
        let shortfall = ONE.wrapping_sub(u64::from(factor));
        let coordinate = u64::from(centre2).wrapping_mul(shortfall) & COORDINATE_MASK;
        Self { coordinate, step: 2 * u64::from(factor) }
    }

    /// The position of the present column; moves on to the next, S[j+1] = S[j] + 2Q.
    #[inline]
    pub(crate) fn advance(&mut self) -> Position {
        let position = self.position();
        self.coordinate = (self.coordinate + self.step) & COORDINATE_MASK;
        position
    }

    /// The position of the present column.
    pub(crate) fn position(&self) -> Position {
        let rounded = (self.coordinate + DROPPED_HALF) >> DROPPED_BITS;
        let fraction = rounded as u32 & ((1 << FRACTION_BITS) - 1);
        Position { n: (rounded >> FRACTION_BITS) as i32, fraction }
    }
}
