//! A queue of bytes in one piece of memory.

/// A queue whose bytes are contiguous, and do not move when the front is taken.
#[derive(Debug, Default)]
pub(super) struct ByteQueue {
    bytes: Vec<u8>,
    start: usize,
}

impl ByteQueue {
    pub(super) fn len(&self) -> usize {
        self.bytes.len() - self.start
    }

    pub(super) fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// All bytes, oldest first.
    pub(super) fn as_slice(&self) -> &[u8] {
        &self.bytes[self.start..]
    }

    /// The oldest bytes: `count` of them, or as many as there are.
    pub(super) fn front(&self, count: usize) -> &[u8] {
        &self.as_slice()[..count.min(self.len())]
    }

    /// Appends `bytes`. The bytes already queued move to the front of the memory only if at least half of it is free there,
    /// so that each byte moves about once.
    pub(super) fn extend(&mut self, bytes: &[u8]) {
        if self.start >= self.len() {
            self.bytes.drain(..self.start);
            self.start = 0;
        }
        self.bytes.extend_from_slice(bytes);
    }

    /// Appends all of `from` and leaves it empty. Nothing is copied when the queue is empty.
    pub(super) fn take_over(&mut self, from: &mut Vec<u8>) {
        if self.is_empty() {
            self.bytes.clear();
            self.start = 0;
            std::mem::swap(&mut self.bytes, from);
        } else {
            self.extend(from);
            from.clear();
        }
    }

    /// Drops the oldest bytes: `count` of them, or as many as there are.
    pub(super) fn consume(&mut self, count: usize) {
        self.start += count.min(self.len());
    }
}

#[cfg(test)]
mod tests {
    use super::ByteQueue;

    #[test]
    fn bytes_come_out_as_they_went_in() {
        let mut queue = ByteQueue::default();
        queue.extend(b"abcdef");
        queue.consume(4);
        queue.extend(b"ghi");
        assert_eq!(queue.as_slice(), b"efghi");
        queue.consume(1);
        queue.extend(b"jklmn");
        assert_eq!((queue.front(3), queue.len()), (b"fgh".as_slice(), 9));
    }

    #[test]
    fn what_is_taken_over_comes_last_and_leaves_its_place_empty() {
        let mut queue = ByteQueue::default();
        let mut from = b"abc".to_vec();
        queue.take_over(&mut from);
        assert!(from.is_empty());
        queue.consume(1);
        from.extend_from_slice(b"de");
        queue.take_over(&mut from);
        assert!(from.is_empty());
        assert_eq!(queue.as_slice(), b"bcde");
    }

    #[test]
    fn an_empty_queue_takes_over_behind_what_it_once_held() {
        let mut queue = ByteQueue::default();
        queue.extend(b"abc");
        queue.consume(3);
        queue.take_over(&mut b"de".to_vec());
        assert_eq!(queue.as_slice(), b"de");
        queue.consume(7);
        assert!(queue.is_empty());
    }
}
