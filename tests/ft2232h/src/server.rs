//! Pending URBs, and what the chip makes of them.

use std::collections::VecDeque;
use std::io::Write as _;
use std::net::Shutdown;
use std::os::unix::net::UnixStream;
use std::time::{Duration, Instant};

use crate::channel::Read;
use crate::chip::{Chip, Setup};
use crate::far_end::Unplugged;
use crate::urb::{Command, Urb, UrbStatus, submitted, unlinked};

/// How often a far end is asked while a host listens.
const TICK: Duration = Duration::from_millis(1);

/// A transfer under way: the packets that a read has taken, or how many bytes of a write the board has taken.
struct Waiting {
    urb: Urb,
    packets: Vec<u8>,
    taken: usize,
}

/// A chip at the end of a socket.
pub(crate) struct Server {
    chip: Chip,
    socket: UnixStream,
    plugged_in: Instant,
    reads: [VecDeque<Waiting>; 2],
    writes: [VecDeque<Waiting>; 2],
    pub(crate) is_gone: bool,
}

impl Server {
    pub(crate) fn new(chip: Chip, socket: UnixStream) -> Self {
        let (reads, writes) = Default::default();
        Self { chip, socket, plugged_in: Instant::now(), reads, writes, is_gone: false }
    }

    /// Carries out a command of the host.
    pub(crate) fn take(&mut self, command: Command) {
        match command {
            Command::Unlink { number, which } => self.unlink(number, which),
            Command::Submit(urb) => self.submit(urb),
        }
    }

    fn submit(&mut self, urb: Urb) {
        let waiting = |urb| Waiting { urb, packets: Vec::new(), taken: 0 };
        match urb.endpoint {
            0x81 | 0x83 => self.reads[usize::from(urb.endpoint == 0x83)].push_back(waiting(urb)),
            0x02 | 0x04 => self.writes[usize::from(urb.endpoint == 0x04)].push_back(waiting(urb)),
            0x00 | 0x80 => return self.control(&urb),
            _ => return self.send(&submitted(&urb, UrbStatus::Stall, 0, &[])),
        }
        self.serve();
    }

    fn control(&mut self, urb: &Urb) {
        let setup = Setup::from(urb.setup);
        let packet = match self.chip.control(setup) {
            None => submitted(urb, UrbStatus::Stall, 0, &[]),
            Some(mut data) if urb.endpoint == 0x80 => {
                data.truncate(setup.length.min(urb.length));
                submitted(urb, UrbStatus::Done, data.len(), &data)
            }
            Some(_) => submitted(urb, UrbStatus::Done, urb.data.len(), &[]),
        };
        self.send(&packet);
    }

    fn unlink(&mut self, number: u32, which: u32) {
        let mut status = UrbStatus::Done;
        for (queue, channel) in self.reads.iter_mut().zip(&mut self.chip.channels) {
            if let Some(place) = queue.iter().position(|waiting| waiting.urb.number == which) {
                let packets = queue.remove(place).map(|waiting| waiting.packets);
                channel.take_back(&packets.unwrap_or_default());
                status = UrbStatus::Unlinked;
            }
        }
        for queue in &mut self.writes {
            let before = queue.len();
            queue.retain(|waiting| waiting.urb.number != which);
            if queue.len() < before {
                status = UrbStatus::Unlinked;
            }
        }
        self.send(&unlinked(number, status));
    }

    /// Moves all bytes that can be moved, and returns how long nothing more will happen by itself; none means for ever.
    pub(crate) fn serve(&mut self) -> Option<Duration> {
        for channel in 0..2 {
            while !self.is_gone && self.serve_channel(channel) {}
        }
        let listening = self.reads.iter().chain(&self.writes).any(|queue| !queue.is_empty());
        (listening && !self.is_gone).then_some(TICK)
    }

    /// Serves one channel. Returns whether a transfer has ended or the board has taken bytes.
    fn serve_channel(&mut self, index: usize) -> bool {
        let now = self.plugged_in.elapsed();
        let channel = &mut self.chip.channels[index];
        let outgoing = self.writes[index].front_mut();
        let bytes = outgoing.as_ref().map_or(&[][..], |waiting| &waiting.urb.data[waiting.taken..]);
        let taken = match channel.write(bytes, now) {
            Ok(taken) => taken,
            Err(Unplugged) => {
                self.unplug();
                return false;
            }
        };
        let mut ended = Vec::new();
        if let Some(waiting) = outgoing {
            waiting.taken += taken;
            if waiting.taken == waiting.urb.data.len() {
                ended.extend(submitted(&waiting.urb, UrbStatus::Done, waiting.taken, &[]));
                self.writes[index].pop_front();
            }
        }
        if let Some(waiting) = self.reads[index].front_mut() {
            let status = match channel.read(waiting.urb.length, &mut waiting.packets, now) {
                Read::Open => None,
                Read::Done => Some(UrbStatus::Done),
                Read::Overflow => Some(UrbStatus::Overflow),
            };
            if let Some(status) = status {
                ended.extend(submitted(&waiting.urb, status, waiting.packets.len(), &waiting.packets));
                self.reads[index].pop_front();
            }
        }
        self.send(&ended);
        !ended.is_empty() || taken > 0
    }

    fn send(&mut self, packets: &[u8]) {
        if self.socket.write_all(packets).is_err() {
            self.unplug();
        }
    }

    /// Pulls the plug: the kernel sees the end of the socket.
    pub(crate) fn unplug(&mut self) {
        self.is_gone = true;
        // It may already be closed; then there is nothing to do.
        let _ = self.socket.shutdown(Shutdown::Both);
    }
}
