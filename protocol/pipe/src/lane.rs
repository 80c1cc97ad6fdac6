//! One direction of the pipe.

use std::collections::VecDeque;
use std::num::NonZeroU64;
use std::time::Duration;

use super::damage::{Damage, Interruption};
use super::options::PipeOptions;
use super::queue::ByteQueue;

/// The most bytes that travel together: a high-speed packet of USB 2.
const SLICE: usize = 512;

const NANOSECONDS: u128 = 1_000_000_000;

/// One direction of the pipe.
#[derive(Debug)]
pub(super) struct Lane {
    speed: Option<NonZeroU64>,
    delay: Duration,
    buffer: usize,
    /// Taken in and not yet handed over.
    bytes: ByteQueue,
    slices: VecDeque<Slice>,
    /// When the pipe last became busy, and how many bytes it has taken since. Times are computed from this total, so that
    /// rounding errors do not add up.
    busy_since: Duration,
    busy_bytes: u64,
    free_at: Duration,
    stalled_until: Duration,
    damage: Damage,
}

#[derive(Debug)]
struct Slice {
    arrives: Duration,
    length: usize,
}

/// What a lane handed over.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Delivery {
    /// Bytes that left the lane, spoilt or not.
    pub(super) bytes: usize,
    /// Whether the pipe broke after them.
    pub(super) broken: bool,
}

impl Lane {
    pub(super) fn new(options: &PipeOptions, damage: Damage) -> Self {
        Self {
            speed: options.speed,
            delay: options.delay,
            buffer: options.buffer,
            bytes: ByteQueue::default(),
            slices: VecDeque::new(),
            busy_since: Duration::ZERO,
            busy_bytes: 0,
            free_at: Duration::ZERO,
            stalled_until: Duration::ZERO,
            damage,
        }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.bytes.is_empty()
    }

    /// Takes in as many bytes from the front of `bytes` as there is room for, and returns their number.
    pub(super) fn accept(&mut self, bytes: &[u8], now: Duration) -> usize {
        let accepted = &bytes[..bytes.len().min(self.room())];
        for slice in accepted.chunks(SLICE) {
            self.occupy(slice.len(), now);
            let arrives = self.free_at.saturating_add(self.delay);
            self.slices.push_back(Slice { arrives, length: slice.len() });
        }
        self.bytes.extend(accepted);
        accepted.len()
    }

    /// How many bytes can be taken in. Without a buffer, the pipe holds one slice at a time.
    fn room(&self) -> usize {
        match self.buffer {
            0 if self.is_empty() => SLICE,
            buffer => buffer.saturating_sub(self.bytes.len()),
        }
    }

    /// Keeps the pipe busy for `length` more bytes, from when it becomes free.
    fn occupy(&mut self, length: usize, now: Duration) {
        if self.free_at <= now {
            (self.busy_since, self.busy_bytes) = (now, 0);
        }
        self.busy_bytes = self.busy_bytes.saturating_add(length as u64);
        let busy_for = self.speed.map_or(Duration::ZERO, |speed| time_for(self.busy_bytes, speed));
        self.free_at = self.busy_since.saturating_add(busy_for);
    }

    /// Appends to `out` what has arrived by `now`, as the fault leaves it.
    pub(super) fn deliver(&mut self, now: Duration, out: &mut Vec<u8>) -> Delivery {
        let mut delivery = Delivery::default();
        while self.stalled_until <= now
            && let Some(slice) = self.slices.front_mut().filter(|slice| slice.arrives <= now)
        {
            let passage = self.damage.pass(self.bytes.front(slice.length), out);
            self.bytes.consume(passage.bytes);
            delivery.bytes += passage.bytes;
            slice.length -= passage.bytes;
            if slice.length == 0 {
                self.slices.pop_front();
            }
            match passage.interruption {
                None => {}
                Some(Interruption::Stall(time)) => self.stalled_until = now.saturating_add(time),
                Some(Interruption::Disconnect) => {
                    delivery.broken = true;
                    break;
                }
            }
        }
        delivery
    }

    /// When the next bytes can be handed over.
    pub(super) fn next_arrival(&self) -> Option<Duration> {
        self.slices.front().map(|slice| slice.arrives.max(self.stalled_until))
    }
}

/// The time that `bytes` take, rounded up to a nanosecond: never early.
fn time_for(bytes: u64, speed: NonZeroU64) -> Duration {
    let nanoseconds = (u128::from(bytes) * NANOSECONDS).div_ceil(u128::from(speed.get()));
    Duration::from_nanos(u64::try_from(nanoseconds).unwrap_or(u64::MAX))
}

#[cfg(test)]
mod tests {
    use super::*;

    const MILLISECOND: Duration = Duration::from_millis(1);

    fn lane(speed: u64, delay: Duration, buffer: usize) -> Lane {
        Lane::new(&PipeOptions { speed: NonZeroU64::new(speed), delay, buffer }, Damage::None)
    }

    /// When bytes arrive and how many have arrived by then.
    fn arrivals(lane: &mut Lane) -> Vec<(Duration, usize)> {
        let mut out = Vec::new();
        std::iter::from_fn(|| {
            let arrival = lane.next_arrival()?;
            lane.deliver(arrival, &mut out);
            Some((arrival, out.len()))
        })
        .collect()
    }

    #[test]
    fn bytes_arrive_in_slices_after_their_time_on_the_wire_and_the_delay() {
        let mut lane = lane(1200, MILLISECOND, 4096);
        assert_eq!(lane.accept(&[7; 1200], Duration::ZERO), 1200);
        // 512/1200 s and 1024/1200 s, rounded up, and 1200/1200 s; 1 ms each.
        let expected = [(427_666_667, 512), (854_333_334, 1024), (1_001_000_000, 1200)];
        assert_eq!(arrivals(&mut lane), expected.map(|(time, bytes)| (Duration::from_nanos(time), bytes)));
    }

    #[test]
    fn bytes_queue_behind_each_other_without_a_gap() {
        let mut lane = lane(1000, Duration::ZERO, 4096);
        lane.accept(&[0; 100], Duration::ZERO);
        lane.accept(&[0; 100], 50 * MILLISECOND);
        assert_eq!(arrivals(&mut lane), [(100 * MILLISECOND, 100), (200 * MILLISECOND, 200)]);
        lane.accept(&[0; 100], 500 * MILLISECOND);
        assert_eq!(arrivals(&mut lane), [(600 * MILLISECOND, 100)], "the pipe was idle in between");
    }

    #[test]
    fn rounding_does_not_add_up() {
        let mut lane = lane(3, Duration::ZERO, 4096);
        (0..3000).for_each(|_| _ = lane.accept(&[0], Duration::ZERO));
        assert_eq!(arrivals(&mut lane).last(), Some(&(Duration::from_secs(1000), 3000)));
    }

    #[test]
    fn without_limit_and_delay_bytes_arrive_at_once() {
        let mut lane = lane(0, Duration::ZERO, 4096);
        assert_eq!(lane.accept(b"abc", MILLISECOND), 3);
        let mut out = Vec::new();
        assert_eq!(lane.deliver(MILLISECOND, &mut out).bytes, 3);
        assert_eq!(out, b"abc");
    }

    #[test]
    fn nothing_arrives_early() {
        let mut lane = lane(1000, MILLISECOND, 4096);
        lane.accept(b"abc", Duration::ZERO);
        let mut out = Vec::new();
        lane.deliver(4 * MILLISECOND - Duration::from_nanos(1), &mut out);
        assert_eq!(out, b"");
        lane.deliver(4 * MILLISECOND, &mut out);
        assert_eq!(out, b"abc");
    }

    #[test]
    fn a_buffer_takes_in_what_fits() {
        let mut lane = lane(1000, Duration::ZERO, 600);
        assert_eq!(lane.accept(&[0; 1000], Duration::ZERO), 600);
        assert_eq!(lane.accept(&[0; 400], Duration::ZERO), 0);
        lane.deliver(512 * MILLISECOND, &mut Vec::new());
        assert_eq!(lane.accept(&[0; 1000], 512 * MILLISECOND), 512);
    }

    #[test]
    fn without_a_buffer_one_slice_is_under_way() {
        let mut lane = lane(1000, MILLISECOND, 0);
        assert_eq!(lane.accept(&[0; 1000], Duration::ZERO), 512);
        assert_eq!(lane.accept(&[0; 488], 512 * MILLISECOND), 0);
        lane.deliver(513 * MILLISECOND, &mut Vec::new());
        assert_eq!(lane.accept(&[0; 488], 513 * MILLISECOND), 488);
    }
}
