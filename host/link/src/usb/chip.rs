//! FTDI's chips as USB devices: what they are called, and how many channels they have.

use crate::ftdi::Speed;

/// Bytes of a packet at full speed, and the most that USB allows there.
pub(super) const FULL_SPEED_PACKET: usize = 64;

/// A kind of chip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Chip {
    /// Two channels, high speed.
    Ft2232h,
    /// Four channels, all of them serial lines, high speed.
    Ft4232h,
    /// One channel, high speed.
    Ft232h,
    /// One channel, full speed: FT232B, FT232R and FT-X.
    FullSpeed,
}

/// A channel of a chip, from 0 for A.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Channel(pub(super) u8);

impl Channel {
    /// A, B, C or D.
    pub(super) fn letter(self) -> char {
        char::from(b'A' + self.0)
    }
}

impl Chip {
    /// The chip with this product id and version.
    pub(super) fn of(product_id: u16, version: u16) -> Option<Self> {
        match (product_id, version) {
            (0x6010, 0x0700..) => Some(Self::Ft2232h),
            (0x6011, _) => Some(Self::Ft4232h),
            (0x6014, _) => Some(Self::Ft232h),
            (0x6001 | 0x6015, _) => Some(Self::FullSpeed),
            _ => None,
        }
    }

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Ft2232h => "FT2232H",
            Self::Ft4232h => "FT4232H",
            Self::Ft232h => "FT232H",
            Self::FullSpeed => "FT232",
        }
    }

    pub(super) fn channels(self) -> u8 {
        match self {
            Self::Ft2232h => 2,
            Self::Ft4232h => 4,
            Self::Ft232h | Self::FullSpeed => 1,
        }
    }

    /// The channel to which boards connect their FPGA; A is their JTAG.
    pub(super) fn usual_channel(self) -> Channel {
        Channel(u8::from(self.channels() > 1))
    }

    /// The endpoints of a channel: to the host, and to the board.
    pub(super) fn endpoints(self, channel: Channel) -> (u8, u8) {
        (0x81 + 2 * channel.0, 0x02 + 2 * channel.0)
    }

    /// How a request's index names a channel.
    pub(super) fn index(self, channel: Channel) -> u16 {
        if self.channels() > 1 { u16::from(channel.0) + 1 } else { 0 }
    }

    /// Bytes of a packet at the chip's fastest speed on USB.
    pub(super) fn packet(self) -> usize {
        if self.is_high_speed() { 512 } else { FULL_SPEED_PACKET }
    }

    pub(super) fn is_high_speed(self) -> bool {
        self.speed() == Speed::High
    }

    /// The family of its baud generator.
    pub(super) fn speed(self) -> Speed {
        if self == Self::FullSpeed { Speed::Full } else { Speed::High }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ftdi::PRODUCTS;

    #[test]
    fn chips_are_told_by_product_and_version() {
        let all: Vec<u16> = (0..=u16::MAX).filter(|&product| Chip::of(product, 0x0700).is_some()).collect();
        assert_eq!(all, PRODUCTS);
        assert_eq!(Chip::of(0x6010, 0x0700), Some(Chip::Ft2232h));
        // The FT2232C of 2004 is no high-speed chip.
        assert_eq!(Chip::of(0x6010, 0x0500), None);
        assert_eq!(Chip::of(0x6001, 0x0400), Some(Chip::FullSpeed));
        assert_eq!(Chip::Ft2232h.usual_channel().letter(), 'B');
        assert_eq!(Chip::Ft2232h.endpoints(Channel(1)), (0x83, 0x04));
        assert_eq!(Chip::Ft232h.endpoints(Chip::Ft232h.usual_channel()), (0x81, 0x02));
    }
}
