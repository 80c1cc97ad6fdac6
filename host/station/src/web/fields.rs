//! The fields of a query.

use std::collections::BTreeMap;
use std::convert::Infallible;

use axum::extract::FromRequestParts;
use axum::http::request::Parts;
use serde::de::DeserializeOwned;
use serde::de::value::{Error, MapDeserializer};

/// The fields of a query, all of which `T` has as text with a default. No query is refused as a whole: of a field that is there
/// twice the last counts, and unknown fields are left out.
pub(super) struct Fields<T>(pub(super) T);

impl<S: Sync, T: DeserializeOwned + Default> FromRequestParts<S> for Fields<T> {
    type Rejection = Infallible;

    async fn from_request_parts(parts: &mut Parts, _: &S) -> Result<Self, Infallible> {
        Ok(Self(of_query(parts.uri.query().unwrap_or_default())))
    }
}

fn of_query<T: DeserializeOwned + Default>(query: &str) -> T {
    let last: BTreeMap<_, _> = form_urlencoded::parse(query.as_bytes()).collect();
    T::deserialize(MapDeserializer::<_, Error>::new(last.into_iter())).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use serde::Deserialize;

    use super::*;

    #[derive(Default, Deserialize)]
    #[serde(default)]
    struct Query {
        serial: String,
        lane: String,
        plan: String,
    }

    #[test]
    fn a_query_is_never_refused_as_a_whole() {
        let asked: Query = of_query("serial=a&serial=b+c&no=1&lane&plan=%ff");
        assert_eq!(
            (asked.serial.as_str(), asked.lane.as_str(), asked.plan.as_str()),
            ("b c", "", "\u{fffd}")
        );
    }
}
