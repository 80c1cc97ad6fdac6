//! Who has a connection, and whose is closed when there is none left.

use std::collections::{BTreeMap, HashMap};
use std::net::IpAddr;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};

use axum::body::Body;
use axum::extract::{Request, State};
use axum::http::header::CONTENT_TYPE;
use axum::middleware::Next;
use axum::response::Response;
use hyper::body::{Body as HttpBody, Bytes, Frame, SizeHint};
use parking_lot::Mutex;
use tokio::sync::Notify;

use super::access::network;

/// How many connections there are at once.
const CONNECTIONS: usize = 64;
/// How many of them one address has.
const CONNECTIONS_OF_ONE: usize = 48;

/// What a connection is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum At {
    /// A request is being answered: it is not broken off.
    Answers,
    /// It sends news. If it is closed, the page opens it again.
    TellsNews,
    /// It waits for a request, or for the rest of a form: it takes no login to begin one, and whoever has begun one has been
    /// promised nothing.
    Waits,
}

/// All connections.
#[derive(Clone, Debug)]
pub(super) struct Slots(Arc<Mutex<Table>>);

#[derive(Debug)]
struct Table {
    of_this_computer: usize,
    /// The number of the last change.
    last: u64,
    taken: BTreeMap<u64, Taken>,
}

#[derive(Debug)]
struct Taken {
    network: IpAddr,
    at: At,
    /// The number of the change since which it does this.
    since: u64,
    close: Arc<Notify>,
}

/// Why there is no slot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NoSlot {
    /// This address has as many as it may.
    OfOne,
    /// All are taken.
    OfAll,
}

impl Slots {
    /// All slots are free. If this computer `has_proxy`, others come through it, so this computer may have all slots.
    pub(super) fn new(has_proxy: bool) -> Self {
        let of_this_computer = if has_proxy { usize::MAX } else { CONNECTIONS_OF_ONE };
        Self(Arc::new(Mutex::new(Table { of_this_computer, last: 0, taken: BTreeMap::new() })))
    }

    /// A slot for `peer`, which is free again when it is dropped. If there is none, another connection gives way: one of the
    /// same address if that has all that it may have, else one of the address with the most connections.
    ///
    /// # Errors
    /// [`NoSlot`] where all that could give way are being answered.
    pub(super) fn take(&self, peer: IpAddr) -> Result<Slot, NoSlot> {
        let (network, mut table) = (network(peer), self.0.lock());
        let most = if network.is_loopback() { table.of_this_computer } else { CONNECTIONS_OF_ONE };
        let own = table.taken.values().filter(|taken| taken.network == network).count();
        if own >= most {
            table.one_gives_way(Some(network)).ok_or(NoSlot::OfOne)?;
        } else if table.taken.len() >= CONNECTIONS {
            table.one_gives_way(None).ok_or(NoSlot::OfAll)?;
        }
        let (number, close) = (table.next(), Arc::new(Notify::new()));
        table
            .taken
            .insert(number, Taken { network, at: At::Waits, since: number, close: Arc::clone(&close) });
        Ok(Slot { all: self.clone(), number, close })
    }
}

impl Table {
    fn next(&mut self) -> u64 {
        self.last += 1;
        self.last
    }

    /// Closes a connection of `network`, or without one of the network with the most connections: the one that has waited
    /// longest for a request or for the rest of a form, or else that has sent news for longest. None if there is none of these.
    fn one_gives_way(&mut self, network: Option<IpAddr>) -> Option<()> {
        let mut counts = HashMap::<IpAddr, usize>::new();
        for taken in self.taken.values() {
            *counts.entry(taken.network).or_default() += 1;
        }
        let may = |taken: &Taken| taken.at != At::Answers && network.is_none_or(|of| of == taken.network);
        let all = self.taken.iter().filter(|(_, taken)| may(taken));
        let (number, _) = all.max_by_key(|(_, taken)| {
            (counts.get(&taken.network), taken.at, std::cmp::Reverse(taken.since))
        })?;
        let number = *number;
        self.taken.remove(&number).map(|taken| taken.close.notify_one())
    }
}

/// The slot of a connection.
#[derive(Debug)]
pub(super) struct Slot {
    all: Slots,
    number: u64,
    close: Arc<Notify>,
}

impl Slot {
    /// Returns when the connection is to give way to another one.
    pub(super) async fn is_lost(&self) {
        self.close.notified().await;
    }

    fn is_at(&self, at: At) {
        let mut table = self.all.0.lock();
        let since = table.next();
        if let Some(taken) = table.taken.get_mut(&self.number) {
            (taken.at, taken.since) = (at, since);
        }
    }
}

impl Drop for Slot {
    fn drop(&mut self) {
        self.all.0.lock().taken.remove(&self.number);
    }
}

/// Goes around every request of a connection, so that its slot knows what it is doing until the end of the answer.
pub(super) async fn noted(State(slot): State<Arc<Slot>>, request: Request, next: Next) -> Response {
    slot.is_at(At::Answers);
    let form = Arc::clone(&slot);
    let request = request.map(|body| Body::new(FormBody { body, slot: form, is_late: false }));
    let busy = Busy(slot);
    let response = next.run(request).await;
    if response.headers().get(CONTENT_TYPE).is_some_and(|kind| kind == "text/event-stream") {
        busy.0.is_at(At::TellsNews);
    }
    response.map(|body| Body::new(BusyBody { body, _busy: busy }))
}

/// A connection that is busy. When this is dropped, it waits for a request again.
struct Busy(Arc<Slot>);

impl Drop for Busy {
    fn drop(&mut self) {
        self.0.is_at(At::Waits);
    }
}

/// The body of a request. While it is awaited, nothing is being answered.
struct FormBody {
    body: Body,
    slot: Arc<Slot>,
    /// Whether it was not all there at once.
    is_late: bool,
}

impl HttpBody for FormBody {
    type Data = Bytes;
    type Error = axum::Error;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        to: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, axum::Error>>> {
        let frame = Pin::new(&mut self.body).poll_frame(to);
        // It counts since when it is awaited, however often a part of it comes.
        if frame.is_pending() && !self.is_late {
            self.is_late = true;
            self.slot.is_at(At::Waits);
        }
        frame
    }

    fn is_end_stream(&self) -> bool {
        self.body.is_end_stream()
    }

    fn size_hint(&self) -> SizeHint {
        self.body.size_hint()
    }
}

impl Drop for FormBody {
    /// It is there, or awaited no more, so that an answer follows.
    fn drop(&mut self) {
        if self.is_late {
            self.slot.is_at(At::Answers);
        }
    }
}

/// The body of an answer, until whose end the connection is busy.
struct BusyBody {
    body: Body,
    _busy: Busy,
}

impl HttpBody for BusyBody {
    type Data = Bytes;
    type Error = axum::Error;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        to: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, axum::Error>>> {
        Pin::new(&mut self.body).poll_frame(to)
    }

    fn is_end_stream(&self) -> bool {
        self.body.is_end_stream()
    }

    fn size_hint(&self) -> SizeHint {
        self.body.size_hint()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn addresses() -> [IpAddr; 4] {
        ["127.0.0.1", "10.0.0.1", "10.0.0.2", "10.0.0.3"].map(|peer| peer.parse().unwrap())
    }

    fn taken(slots: &Slots, peer: IpAddr, count: usize) -> Vec<Slot> {
        (0..count).map(|_| slots.take(peer).unwrap()).collect()
    }

    /// Which of these were told to give way.
    fn lost(of: &[Slot]) -> Vec<usize> {
        let is_there = |slot: &Slot| slot.all.0.lock().taken.contains_key(&slot.number);
        of.iter().enumerate().filter(|(_, slot)| !is_there(slot)).map(|(number, _)| number).collect()
    }

    #[test]
    fn no_address_has_all_connections_but_that_of_a_proxy() {
        let [here, one, other, _] = addresses();
        for (has_proxy, peer, most) in
            [(false, one, 48), (true, one, 48), (false, here, 48), (true, here, 64)]
        {
            let slots = Slots::new(has_proxy);
            let busy = taken(&slots, peer, most);
            busy.iter().for_each(|slot| slot.is_at(At::Answers));
            let none = if most == 64 { NoSlot::OfAll } else { NoSlot::OfOne };
            assert_eq!(slots.take(peer).unwrap_err(), none, "{has_proxy} {peer}");
            assert_eq!(slots.take(other).is_ok(), most < 64, "{has_proxy} {peer}");
            busy[7].is_at(At::Waits);
            let late = slots.take(peer).unwrap();
            assert_eq!(lost(&busy), [7]);
            drop((busy, late));
            assert_eq!(taken(&slots, peer, most).len(), most);
        }
    }

    #[test]
    fn who_has_waited_longest_gives_way_before_news_and_no_request_does() {
        let [here, ..] = addresses();
        let slots = Slots::new(false);
        let all = taken(&slots, here, 48);
        all.iter().for_each(|slot| slot.is_at(At::Answers));
        all[5].is_at(At::TellsNews);
        all[4].is_at(At::TellsNews);
        all[9].is_at(At::Waits);
        all[8].is_at(At::Waits);
        let mut late = Vec::new();
        for gone in [&[9][..], &[8, 9], &[5, 8, 9], &[4, 5, 8, 9]] {
            late.push(slots.take(here).unwrap());
            late.iter().for_each(|slot| slot.is_at(At::Answers));
            assert_eq!(lost(&all), gone);
        }
        assert_eq!(slots.take(here).unwrap_err(), NoSlot::OfOne);
    }

    #[test]
    fn where_all_are_taken_the_address_that_has_most_gives_way() {
        let [here, one, other, new] = addresses();
        let slots = Slots::new(false);
        let (few, many, some) = (taken(&slots, here, 10), taken(&slots, one, 34), taken(&slots, other, 20));
        many.iter().for_each(|slot| slot.is_at(At::TellsNews));
        let late = taken(&slots, new, 3);
        assert_eq!((lost(&few), lost(&many), lost(&some)), (vec![], vec![0, 1, 2], vec![]));
        many.iter().for_each(|slot| slot.is_at(At::Answers));
        let later = slots.take(new).unwrap();
        assert_eq!((lost(&few), lost(&some), late.len()), (vec![], vec![0], 3));
        drop(later);
    }
}
