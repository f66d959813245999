//! Configuration of the session, from the same sources as in `rmw_zenoh_cpp`.

use std::env;

use opendr_engine::{Error, Result};
use zenoh::Config;

/// Defaults of rmw_zenoh: a peer that discovers others through the router of this machine, not by multicast.
const DEFAULTS: [(&str, &str); 4] = [
    ("mode", "\"peer\""),
    ("connect/endpoints", "[\"tcp/localhost:7447\"]"),
    ("listen/endpoints", "[\"tcp/localhost:0\"]"),
    ("scouting/multicast/enabled", "false"),
];

/// Returns the configuration of `ZENOH_SESSION_CONFIG_URI` or the defaults, with `ZENOH_CONFIG_OVERRIDE`, a list of
/// `key/path=value;`.
pub(super) fn config() -> Result<Config> {
    let mut config = match set("ZENOH_SESSION_CONFIG_URI") {
        Some(path) => Config::from_file(&path)
            .map_err(|error| Error::invalid_param(format!("ZENOH_SESSION_CONFIG_URI, {path}: {error}")))?,
        None => {
            let mut config = Config::default();
            for (key, value) in DEFAULTS {
                config
                    .insert_json5(key, value)
                    .map_err(|error| Error::internal(format!("{key}: {error}")))?;
            }
            config
        }
    };
    for pair in set("ZENOH_CONFIG_OVERRIDE").iter().flat_map(|pairs| pairs.split(';')) {
        if pair.trim().is_empty() {
            continue;
        }
        let set = pair.split_once('=').ok_or_else(|| "there is no =".to_owned()).and_then(|(key, value)| {
            config.insert_json5(key.trim(), value.trim()).map_err(|error| error.to_string())
        });
        set.map_err(|error| Error::invalid_param(format!("ZENOH_CONFIG_OVERRIDE, {pair:?}: {error}")))?;
    }
    Ok(config)
}

fn set(variable: &str) -> Option<String> {
    env::var(variable).ok().filter(|text| !text.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_are_keys_of_zenoh() {
        let config = config().unwrap();
        assert!(config.get_json("connect/endpoints").unwrap().contains("tcp/localhost:7447"));
        assert_eq!(config.get_json("scouting/multicast/enabled").unwrap(), "false");
    }
}
