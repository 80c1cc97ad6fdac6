//! The bit depths of a sample.

/// Bits of a sample (B in DATAPATH.md).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Depth {
    /// 8 bits, 0 to 255.
    Eight,
    /// 10 bits, 0 to 1023.
    Ten,
    /// 12 bits, 0 to 4095.
    Twelve,
}

impl Depth {
    /// All depths, ascending.
    pub const ALL: [Self; 3] = [Self::Eight, Self::Ten, Self::Twelve];

    /// The depth of `bits` bits; none unless that is 8, 10 or 12.
    #[must_use]
    pub fn from_bits(bits: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|depth| depth.bits() == bits)
    }

    /// Bits a sample.
    #[must_use]
    pub const fn bits(self) -> u8 {
        match self {
            Self::Eight => 8,
            Self::Ten => 10,
            Self::Twelve => 12,
        }
    }

    /// The largest sample, 2^B − 1.
    #[must_use]
    pub const fn largest(self) -> u16 {
        (1 << self.bits()) - 1
    }
}
