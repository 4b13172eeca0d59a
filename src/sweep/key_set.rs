//! Keys that a point sets, as a list that takes little memory: a study has as many of them as points.

use std::collections::BTreeMap;
use std::fmt;

use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::Value;

/// Keys with their values, each once, in the order of the keys. As JSON it is an object.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct KeySet(Box<[(Box<str>, Value)]>);

impl KeySet {
    /// The value of a key.
    pub fn get(&self, key: &str) -> Option<&Value> {
        self.0.binary_search_by(|(known, _)| (**known).cmp(key)).ok().map(|at| &self.0[at].1)
    }

    /// Keys with their values.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &Value)> {
        self.0.iter().map(|(key, value)| (&**key, value))
    }
}

impl<K: AsRef<str>> FromIterator<(K, Value)> for KeySet {
    /// Of values of the same key, the last one counts.
    fn from_iter<I: IntoIterator<Item = (K, Value)>>(keys: I) -> KeySet {
        let keys: BTreeMap<Box<str>, Value> =
            keys.into_iter().map(|(key, value)| (key.as_ref().into(), value)).collect();
        KeySet(keys.into_iter().collect())
    }
}

impl Serialize for KeySet {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.iter())
    }
}

impl<'de> Deserialize<'de> for KeySet {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<KeySet, D::Error> {
        struct KeySetVisitor;

        impl<'de> Visitor<'de> for KeySetVisitor {
            type Value = KeySet;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a map")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<KeySet, A::Error> {
                let mut keys: Vec<(String, Value)> = Vec::with_capacity(8);
                while let Some(entry) = map.next_entry()? {
                    keys.push(entry);
                }
                Ok(keys.into_iter().collect())
            }
        }

        deserializer.deserialize_map(KeySetVisitor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_value_of_a_key_counts_and_json_is_in_their_order() {
        let keys: KeySet = [("b", 1.into()), ("a", "x".into()), ("b", 2.into())].into_iter().collect();
        let text = serde_json::to_string(&keys).unwrap();
        assert_eq!(text, r#"{"a":"x","b":2}"#);
        assert_eq!(serde_json::from_str::<KeySet>(&text).unwrap(), keys);
        assert_eq!(serde_json::from_str::<KeySet>(r#"{"b":1,"a":"x","b":2}"#).unwrap(), keys);
        assert_eq!((keys.get("b"), keys.get("c")), (Some(&Value::from(2)), None));
        assert!(serde_json::from_str::<KeySet>("[1]").unwrap_err().to_string().contains("expected a map"));
    }
}
