//! FTDI's chips: what they are called, how many channels they have, and what their baud generators can do.

/// FTDI's vendor id.
pub(super) const FTDI: u16 = 0x0403;

/// How far a rate may be from the one that is asked for. A receiver samples the last of ten bits half a bit from its edge,
/// so 5 % lose it; either side may spend a share of that.
const TOLERANCE: f64 = 0.02;

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

    /// The channel where boards have their FPGA: A is their JTAG.
    pub(super) fn usual_channel(self) -> Channel {
        Channel(u8::from(self.channels() > 1))
    }

    /// The endpoints of a channel, to the host and to the board.
    pub(super) fn endpoints(self, channel: Channel) -> (u8, u8) {
        (0x81 + 2 * channel.0, 0x02 + 2 * channel.0)
    }

    /// What stands for a channel in a request's index.
    pub(super) fn index(self, channel: Channel) -> u16 {
        if self.channels() > 1 { u16::from(channel.0) + 1 } else { 0 }
    }

    /// Bytes of a packet.
    pub(super) fn packet(self) -> usize {
        if self.is_high_speed() { 512 } else { 64 }
    }

    pub(super) fn is_high_speed(self) -> bool {
        self != Self::FullSpeed
    }

    /// The fastest serial rate.
    pub(super) fn fastest(self) -> u32 {
        if self.is_high_speed() { 12_000_000 } else { 3_000_000 }
    }

    /// The divisor for `baud`, as the request wants it: eighths in bits 14 to 16, bit 17 for the 12 MHz clock.
    ///
    /// Next to the fastest rate there are two more without eighths, 2/3 and 1/2 of it. What a high-speed chip makes
    /// between the fastest and a half jitters and collapses to 2/3, so those rates are refused, 2/3 included.
    ///
    /// # Errors
    /// The nearest rates that the chip makes, the lower first, when none is close enough.
    pub(super) fn divisor(self, baud: u32) -> Result<u32, Vec<u32>> {
        const EIGHTHS: [u32; 8] = [0, 3, 2, 4, 1, 5, 6, 7];
        let fastest = f64::from(self.fastest());
        let wanted = f64::from(baud).max(1.0);
        // The slowest divisor is 2^14 - 1 and seven eighths.
        let near = (8.0 * fastest / wanted).clamp(8.0, 131_071.0);
        let mut rates: Vec<(f64, u32)> = [near.floor(), near.ceil(), 8.0, 12.0, 16.0]
            .into_iter()
            .filter(|&eighths| eighths == 8.0 || eighths >= 16.0 || !self.is_high_speed() && eighths == 12.0)
            .map(|eighths| (8.0 * fastest / eighths, eighths as u32))
            .collect();
        rates.sort_by(|one, other| (one.0 - wanted).abs().total_cmp(&(other.0 - wanted).abs()));
        rates.dedup();
        let (rate, eighths) = rates[0];
        if (rate - wanted).abs() > TOLERANCE * wanted {
            let mut nearest: Vec<u32> = rates.iter().take(2).map(|(rate, _)| rate.round() as u32).collect();
            nearest.sort_unstable();
            return Err(nearest);
        }
        let divisor = match eighths {
            8 => 0,
            12 => 1,
            _ => eighths >> 3 | EIGHTHS[(eighths & 7) as usize] << 14,
        };
        Ok(if self.is_high_speed() { divisor | 0x20000 } else { divisor })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_divisors_of_a_high_speed_chip_are_those_of_its_data_sheet() {
        for (baud, divisor) in [
            (12_000_000, 0x20000),
            (6_000_000, 0x20002),
            (3_000_000, 0x20004),
            (2_000_000, 0x20006),
            (1_000_000, 0x2000c),
            (921_600, 0x2000d),
            (115_200, 0x2c068),
        ] {
            assert_eq!(Chip::Ft2232h.divisor(baud), Ok(divisor), "{baud}");
        }
    }

    #[test]
    fn the_divisors_of_a_full_speed_chip_are_those_of_its_data_sheet() {
        // AN232B-05: 3 M, 2 M, 921,600 (3.25), 115,200 (26), 9600 (312.5).
        for (baud, divisor) in
            [(3_000_000, 0), (2_000_000, 1), (921_600, 0x8003), (115_200, 0x1a), (9600, 0x4138)]
        {
            assert_eq!(Chip::FullSpeed.divisor(baud), Ok(divisor), "{baud}");
        }
    }

    #[test]
    fn a_rate_that_a_chip_cannot_make_is_refused_with_those_beside_it() {
        for baud in [7_000_000, 8_000_000, 9_000_000, 10_000_000, 11_000_000] {
            assert_eq!(Chip::Ft2232h.divisor(baud), Err(vec![6_000_000, 12_000_000]), "{baud}");
        }
        assert_eq!(Chip::Ft2232h.divisor(20_000_000), Err(vec![6_000_000, 12_000_000]));
        // 96 MHz / 5.82 MHz is 16.5: 2.9 % away on either side.
        assert_eq!(Chip::Ft2232h.divisor(5_820_000), Err(vec![5_647_059, 6_000_000]));
        assert_eq!(Chip::FullSpeed.divisor(12_000_000), Err(vec![2_000_000, 3_000_000]));
        assert!(Chip::Ft2232h.divisor(0).is_err());
    }

    #[test]
    fn chips_are_told_by_product_and_version() {
        assert_eq!(Chip::of(0x6010, 0x0700), Some(Chip::Ft2232h));
        // The FT2232C of 2004 is no high-speed chip.
        assert_eq!(Chip::of(0x6010, 0x0500), None);
        assert_eq!(Chip::of(0x6001, 0x0400), Some(Chip::FullSpeed));
        assert_eq!(Chip::Ft2232h.usual_channel().letter(), 'B');
        assert_eq!(Chip::Ft2232h.endpoints(Channel(1)), (0x83, 0x04));
        assert_eq!(Chip::Ft232h.endpoints(Chip::Ft232h.usual_channel()), (0x81, 0x02));
    }
}
