//! Name or address of this machine for other nodes, as in roscpp and rospy.

use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, UdpSocket};

use crate::http::HttpUri;

/// Returns `given`, else `ROS_HOSTNAME`, else `ROS_IP`, else the machine's name, else its address towards `master`.
pub(crate) fn host(given: Option<&str>, master: &HttpUri) -> String {
    let from_environment =
        || ["ROS_HOSTNAME", "ROS_IP"].into_iter().find_map(|key| set(std::env::var(key).ok()));
    let machine = || machine_name().filter(|name| name != "localhost" && !name.starts_with("127."));
    set(given.map(str::to_owned))
        .or_else(from_environment)
        .or_else(machine)
        .or_else(|| address_towards(master))
        .unwrap_or_else(|| "127.0.0.1".to_owned())
}

/// Returns the address to listen on: the loopback if `host` is a loopback name, as in rospy; IPv6 if `ROS_IPV6` is `on`.
pub(crate) fn bind_address(host: &str) -> IpAddr {
    let ipv6 = std::env::var("ROS_IPV6").is_ok_and(|value| value == "on");
    let loopback = host.parse::<IpAddr>().map_or(host == "localhost", |address| address.is_loopback());
    match (host.parse::<IpAddr>(), loopback, ipv6) {
        (Ok(address), true, _) => address,
        (_, true, false) => Ipv4Addr::LOCALHOST.into(),
        (_, true, true) => Ipv6Addr::LOCALHOST.into(),
        (_, false, false) => Ipv4Addr::UNSPECIFIED.into(),
        (_, false, true) => Ipv6Addr::UNSPECIFIED.into(),
    }
}

fn set(value: Option<String>) -> Option<String> {
    value.filter(|value| !value.trim().is_empty())
}

#[cfg(unix)]
fn machine_name() -> Option<String> {
    let mut name = [0_u8; 256];
    // SAFETY: the buffer is writable for the length handed over.
    let failed = unsafe { libc::gethostname(name.as_mut_ptr().cast(), name.len()) };
    let end = name.iter().position(|byte| *byte == 0)?;
    let name = str::from_utf8(name.get(..end)?).ok()?;
    set((failed == 0).then(|| name.to_owned()))
}

#[cfg(not(unix))]
fn machine_name() -> Option<String> {
    set(std::env::var("COMPUTERNAME").ok())
}

/// Connects a datagram socket, which sends nothing and only selects the route.
fn address_towards(master: &HttpUri) -> Option<String> {
    let socket = UdpSocket::bind((Ipv4Addr::UNSPECIFIED, 0)).ok()?;
    socket.connect((master.host.as_str(), master.port)).ok()?;
    socket.local_addr().ok().map(|address| address.ip().to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn given_host_has_priority() {
        let master = HttpUri::new("http://localhost:11311").unwrap();
        assert_eq!(host(Some("10.0.0.7"), &master), "10.0.0.7");
        assert!(!host(None, &master).is_empty());
    }

    #[test]
    fn a_loopback_name_listens_on_the_loopback() {
        assert!(bind_address("127.0.0.1").is_loopback());
        assert!(bind_address("localhost").is_loopback());
        assert!(bind_address("::1").is_loopback());
        assert!(bind_address("robot").is_unspecified());
        assert!(bind_address("10.0.0.7").is_unspecified());
    }
}
