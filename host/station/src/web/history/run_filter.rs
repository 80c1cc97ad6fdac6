//! What a query asks for, and the query that asks for it.

use clap::ValueEnum;
use form_urlencoded::Serializer;
use halfrow::Verdict;
use serde::Deserialize;

use crate::history::runs::{Cursor, Filter};
use crate::history::yields::Wanted;
use crate::history::{Period, moment};
use crate::plan::PlanName;
use crate::web::trouble::Trouble;
use crate::web::visit::Visit;

/// The fields of every form of the history. What is empty asks for nothing.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct RunFilter {
    pub(super) serial: String,
    pub(super) verdict: String,
    pub(super) product: String,
    pub(super) plan: String,
    pub(super) station: String,
    pub(super) lane: String,
    pub(super) operator: String,
    /// The first day, or moment.
    pub(super) from: String,
    /// The last day, or the first moment after.
    pub(super) until: String,
    /// Plan, day, week, lane or station of a yield; part or check of failures.
    pub(super) by: String,
    /// The cursor after which the page begins.
    after: String,
}

/// A value that cannot be searched for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Wrong(String);

impl Wrong {
    /// The error in the visitor's language.
    pub(super) fn told(self, visit: &Visit) -> Trouble {
        Trouble::wrong(visit, visit.words.fill("history.wrong", &[("value", &self.0)]))
    }
}

impl RunFilter {
    /// A query for this serial number.
    pub(super) fn of_serial(serial: &str) -> Self {
        Self { serial: serial.to_owned(), ..Self::default() }
    }

    /// The query as a filter of runs.
    ///
    /// # Errors
    /// [`Wrong`] when a value is not valid.
    pub(super) fn filter(&self) -> Result<Filter, Wrong> {
        let is_asked = |verdict: &Verdict| self.verdict.eq_ignore_ascii_case(verdict.name());
        let verdict = Verdict::ALL.into_iter().find(is_asked);
        if verdict.is_none() && !self.verdict.is_empty() {
            return Err(Wrong(self.verdict.clone()));
        }
        Ok(Filter {
            // What was scanned is taken as it is: a blank at its end is part of it.
            serial: Some(self.serial.clone()).filter(|serial| !serial.is_empty()),
            verdict,
            product: some(&self.product),
            plan: some(&self.plan),
            station: some(&self.station),
            lane: some(&self.lane),
            operator: some(&self.operator),
            period: self.period()?,
        })
    }

    /// The query as what is to be counted.
    ///
    /// # Errors
    /// Like [`Self::filter`].
    pub(super) fn wanted(&self) -> Result<Wanted, Wrong> {
        Ok(Wanted {
            product: some(&self.product),
            plan: some(&self.plan),
            station: some(&self.station),
            lane: some(&self.lane),
            period: self.period()?,
        })
    }

    /// The cursor after which the page begins.
    ///
    /// # Errors
    /// Like [`Self::filter`].
    pub(super) fn after(&self) -> Result<Option<Cursor>, Wrong> {
        some(&self.after).map(|after| after.parse().map_err(|_| Wrong(after.clone()))).transpose()
    }

    /// What `by` names; the default when it is empty.
    ///
    /// # Errors
    /// Like [`Self::filter`].
    pub(super) fn by<T: ValueEnum + Default>(&self) -> Result<T, Wrong> {
        if self.by.is_empty() {
            return Ok(T::default());
        }
        T::from_str(&self.by, false).map_err(|_| Wrong(self.by.clone()))
    }

    fn period(&self) -> Result<Period, Wrong> {
        let all = Period::default();
        let moment = |text: &str, days| moment(text, days).ok_or_else(|| Wrong(text.to_owned()));
        let from_ms = some(&self.from).map_or(Ok(all.from_ms), |from| moment(&from, 0))?;
        let until_ms = some(&self.until).map_or(Ok(all.until_ms), |until| moment(&until, 1))?;
        // There is no moment in it, and what is found in none looks like a line without failures.
        if until_ms <= from_ms { Err(Wrong(self.until.clone())) } else { Ok(Period { from_ms, until_ms }) }
    }

    /// The address at `path` with the same query, from the run after `after` on.
    pub(super) fn address(&self, path: &str, after: Option<&Cursor>) -> String {
        let after = after.map(ToString::to_string).unwrap_or_default();
        let Self { serial, verdict, product, plan, station, lane, operator, from, until, by, after: _ } =
            self;
        let all = [
            ("serial", serial),
            ("verdict", verdict),
            ("product", product),
            ("plan", plan),
            ("station", station),
            ("lane", lane),
            ("operator", operator),
            ("from", from),
            ("until", until),
            ("by", by),
            ("after", &after),
        ];
        let mut query = Serializer::new(String::new());
        query.extend_pairs(all.into_iter().filter(|(_, value)| !value.is_empty()));
        match query.finish() {
            query if query.is_empty() => path.to_owned(),
            query => format!("{path}?{query}"),
        }
    }

    /// The address of those runs of the query that are of this station under this plan.
    pub(super) fn address_of(&self, station: &str, PlanName { product, plan }: &PlanName) -> String {
        let [station, product, plan] = [station, product, plan].map(ToOwned::to_owned);
        Self { station, product, plan, by: String::new(), ..self.clone() }.address("/history", None)
    }

    /// Whether it asks for a page that is not the first.
    pub(super) fn is_further(&self) -> bool {
        !self.after.is_empty()
    }
}

/// The address of the page of a serial number.
pub(in crate::web) fn unit_address(serial: &str) -> String {
    RunFilter::of_serial(serial).address("/unit", None)
}

/// The address of the runs of a plant's station.
pub(in crate::web) fn station_address(station: &str) -> String {
    RunFilter { station: station.to_owned(), ..RunFilter::default() }.address("/history", None)
}

fn some(text: &str) -> Option<String> {
    Some(text.trim().to_owned()).filter(|text| !text.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_asks_for_what_was_asked_for() {
        let asked = RunFilter { serial: "A&B=ü#".to_owned(), lane: "1".to_owned(), ..RunFilter::default() };
        assert_eq!(asked.address("/history", None), "/history?serial=A%26B%3D%C3%BC%23&lane=1");
        assert_eq!(RunFilter::default().address("/history", None), "/history");
    }

    #[test]
    fn a_serial_number_is_looked_for_as_it_is() {
        let asked = RunFilter { serial: " A ".to_owned(), lane: " 1 ".to_owned(), ..RunFilter::default() };
        let Filter { serial, lane, operator, .. } = asked.filter().unwrap();
        assert_eq!([serial, lane, operator], [Some(" A ".to_owned()), Some("1".to_owned()), None]);
    }
}
