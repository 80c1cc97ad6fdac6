//! One channel: two FIFOs, a latency timer, and packets that begin with two status bytes.

use std::time::Duration;

use crate::eeprom::ChannelMode;
use crate::far_end::{FarEnd, Unplugged};

/// The status bytes in front of every packet.
const STATUS: usize = 2;

/// Bytes that the chip buffers towards the host.
const FIFO: usize = 4096;

/// CTS, DSR and DCD are active; and the low bits that the chip always sets.
const MODEM_STATUS: u8 = 0xb1;

/// Both transmitter registers are empty.
const LINE_STATUS: u8 = 0x60;

const FRAMING_ERROR: u8 = 0x08;

/// By what share two baud rates may differ.
const TOLERANCE: f64 = 0.03;

/// What came of a read by the host.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Read {
    /// There is no packet for it yet.
    Open,
    /// It is complete.
    Done,
    /// The next packet is longer than what is left of the buffer.
    Overflow,
}

/// A channel and what is connected to it.
pub(crate) struct Channel {
    mode: ChannelMode,
    /// Bytes of a packet.
    packet: usize,
    far_end: Option<Box<dyn FarEnd>>,
    to_host: Vec<u8>,
    latency: Duration,
    /// When the last packet left.
    packet_at: Duration,
    /// The board has strobed SIWU#: what is in the FIFO is sent at once.
    send_immediately: bool,
    /// The rate at which the board talks, and the one that the host has set.
    board_baud: Option<f64>,
    baud: f64,
    /// Whether the last byte was spoilt by a wrong rate.
    spoilt: bool,
}

impl Channel {
    pub(crate) fn new(
        mode: ChannelMode,
        packet: usize,
        far_end: Option<Box<dyn FarEnd>>,
        board_baud: Option<u32>,
    ) -> Self {
        Self {
            mode,
            packet,
            far_end,
            to_host: Vec::new(),
            latency: Duration::from_millis(16),
            packet_at: Duration::ZERO,
            send_immediately: false,
            board_baud: board_baud.filter(|_| mode == ChannelMode::Uart).map(f64::from),
            baud: 9600.0,
            spoilt: false,
        }
    }

    /// Puts bytes into the FIFO before the host asks for any.
    pub(crate) fn put_in_fifo(&mut self, bytes: &[u8]) {
        self.to_host.extend_from_slice(bytes);
    }

    pub(crate) fn drop_bytes_to_host(&mut self) {
        self.to_host.clear();
    }

    pub(crate) fn latency(&self) -> u8 {
        self.latency.as_millis() as u8
    }

    pub(crate) fn set_latency(&mut self, milliseconds: u8) {
        self.latency = Duration::from_millis(milliseconds.into());
    }

    /// The rate that a divisor stands for: eighths in bits 14 to 16, the 12 MHz clock chosen by bit 17.
    pub(crate) fn set_divisor(&mut self, divisor: u32) {
        const EIGHTHS: [u32; 8] = [0, 4, 2, 1, 3, 5, 6, 7];
        let clock = if divisor & 0x20000 == 0 { 3e6 } else { 12e6 };
        let eighths = EIGHTHS[(divisor >> 14 & 7) as usize];
        self.baud = match divisor & 0x1_ffff {
            0 => clock,
            1 => clock / 1.5,
            _ => clock / (f64::from(divisor & 0x3fff) + f64::from(eighths) / 8.0),
        };
    }

    pub(crate) fn status(&self) -> [u8; STATUS] {
        let error = if self.spoilt { FRAMING_ERROR } else { 0 };
        [MODEM_STATUS, LINE_STATUS | error]
    }

    /// Takes bytes from the host, and lets the board send what it has.
    pub(crate) fn write(&mut self, bytes: &[u8], now: Duration) -> Result<usize, Unplugged> {
        let Some(far_end) = &mut self.far_end else { return Ok(bytes.len()) };
        let wrong_rate = self.board_baud.is_some_and(|board| (self.baud / board - 1.0).abs() > TOLERANCE);
        let before = self.to_host.len();
        if before >= FIFO {
            return Ok(0);
        }
        if !wrong_rate {
            let taken = far_end.exchange(bytes, &mut self.to_host, now)?;
            self.send_immediately |= self.mode == ChannelMode::Fifo && self.to_host.len() > before;
            self.spoilt = false;
            return Ok(taken);
        }
        // Bits are sampled at the wrong times: both ends receive something, but never what was sent.
        let spoil = |byte: &u8| byte.rotate_left(3) ^ 0xa5;
        let spoilt: Vec<u8> = bytes.iter().map(spoil).collect();
        let taken = far_end.exchange(&spoilt, &mut self.to_host, now)?;
        self.to_host[before..].iter_mut().for_each(|byte| *byte = spoil(byte));
        self.spoilt |= self.to_host.len() > before || taken > 0;
        if taken > 0 {
            self.to_host.push(0xff);
        }
        Ok(taken)
    }

    /// Appends packets to `filled`, up to `length` bytes in all: full ones at once, a short one when the latency timer has run
    /// out or the board has strobed SIWU#.
    pub(crate) fn read(&mut self, length: usize, filled: &mut Vec<u8>, now: Duration) -> Read {
        let most = self.packet - STATUS;
        while filled.len() < length {
            let is_full = self.to_host.len() >= most;
            if !is_full && !self.send_immediately && now < self.due() {
                return Read::Open;
            }
            let data = self.to_host.len().min(most);
            if STATUS + data > length - filled.len() {
                return Read::Overflow;
            }
            filled.extend(self.status());
            filled.extend(self.to_host.drain(..data));
            self.packet_at = now;
            self.send_immediately &= !self.to_host.is_empty();
            if data < most {
                return Read::Done;
            }
        }
        Read::Done
    }

    /// When the latency timer runs out.
    pub(crate) fn due(&self) -> Duration {
        self.packet_at + self.latency
    }

    /// Takes back packets of a read that the host gave up.
    pub(crate) fn take_back(&mut self, packets: &[u8]) {
        let data: Vec<u8> = packets
            .chunks(self.packet)
            .flat_map(|packet| packet.get(STATUS..).unwrap_or_default())
            .copied()
            .collect();
        self.to_host.splice(..0, data);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::far_end::Loopback;

    const MS: Duration = Duration::from_millis(1);

    fn loopback(mode: ChannelMode) -> Channel {
        Channel::new(mode, 512, Some(Box::new(Loopback::default())), None)
    }

    #[test]
    fn full_packets_go_at_once_and_the_rest_when_the_timer_has_run_out() {
        let mut channel = loopback(ChannelMode::Uart);
        assert_eq!(channel.write(&[7; 600], MS), Ok(600));
        let mut filled = Vec::new();
        assert_eq!(channel.read(1024, &mut filled, MS), Read::Open);
        assert_eq!(filled.len(), 512);
        assert_eq!(channel.read(1024, &mut filled, 17 * MS), Read::Done);
        assert_eq!((filled.len(), &filled[510..516]), (604, &[7, 7, 0xb1, 0x60, 7, 7][..]));
    }

    #[test]
    fn packets_of_full_speed_have_64_bytes() {
        let mut channel = Channel::new(ChannelMode::Fifo, 64, Some(Box::new(Loopback::default())), None);
        assert_eq!(channel.write(&[7; 63], MS), Ok(63));
        let mut filled = Vec::new();
        assert_eq!(channel.read(512, &mut filled, MS), Read::Done);
        assert_eq!((filled.len(), &filled[62..]), (67, &[7, 7, 0xb1, 0x60, 7][..]));
    }

    #[test]
    fn nothing_to_say_is_two_bytes() {
        let mut filled = Vec::new();
        assert_eq!(loopback(ChannelMode::Uart).read(512, &mut filled, 16 * MS), Read::Done);
        assert_eq!(filled, [0xb1, 0x60]);
    }

    #[test]
    fn a_fifo_s_board_does_not_wait_for_the_timer() {
        let mut channel = loopback(ChannelMode::Fifo);
        assert_eq!(channel.write(&[7; 3], MS), Ok(3));
        let mut filled = Vec::new();
        assert_eq!((channel.read(512, &mut filled, MS), filled.len()), (Read::Done, 5));
        assert_eq!(channel.read(512, &mut Vec::new(), MS), Read::Open);
    }

    #[test]
    fn a_packet_that_does_not_fit_overflows() {
        let mut channel = loopback(ChannelMode::Fifo);
        assert_eq!(channel.write(&[7; 600], MS), Ok(600));
        assert_eq!(channel.read(600, &mut Vec::new(), MS), Read::Overflow);
    }

    #[test]
    fn what_was_taken_back_comes_again() {
        let mut channel = loopback(ChannelMode::Fifo);
        let sent: Vec<u8> = (0..700).map(|n| n as u8).collect();
        assert_eq!(channel.write(&sent, MS), Ok(700));
        let (mut first, mut second) = (Vec::new(), Vec::new());
        assert_eq!(channel.read(1024, &mut first, MS), Read::Done);
        channel.take_back(&first);
        assert_eq!(channel.read(1024, &mut second, 20 * MS), Read::Open);
        assert_eq!(channel.read(1024, &mut second, 40 * MS), Read::Done);
        assert_eq!(first, second);
    }

    #[test]
    fn divisors_of_the_data_sheet_are_its_rates() {
        // AN232B-05 and AN120: 12 M, 8 M, 115,200 (104.125), 921,600 (13).
        let rates = [(0x20000, 12e6), (0x20001, 8e6), (0x2c068, 12e6 / 104.125), (0x2000d, 12e6 / 13.0)];
        for (divisor, rate) in rates {
            let mut channel = loopback(ChannelMode::Uart);
            channel.set_divisor(divisor);
            assert!((channel.baud - rate).abs() < 1e-6, "{divisor:x}: {}", channel.baud);
        }
    }

    #[test]
    fn another_rate_than_the_board_s_spoils_what_is_sent_and_says_so() {
        let far_end = Box::new(Loopback::default());
        let mut channel = Channel::new(ChannelMode::Uart, 512, Some(far_end), Some(3_000_000));
        channel.set_divisor(0x20000);
        assert_eq!(channel.write(&[1, 2, 3], MS), Ok(3));
        let mut filled = Vec::new();
        assert_eq!(channel.read(512, &mut filled, 20 * MS), Read::Done);
        assert_eq!(filled[1] & FRAMING_ERROR, FRAMING_ERROR);
        assert_ne!(filled[2..5], [1, 2, 3]);
    }
}
