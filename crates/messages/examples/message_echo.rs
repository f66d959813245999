//! Reads and rewrites messages: for every line `TYPE WIRE HEX` prints a line of hexadecimal digits, or `error: ...`.
//!
//! WIRE is `cdr` or `ros1`, or two of them with `>` between to read the one and write the other. Requests and responses
//! of services are types too (`std_srvs/srv/SetBool_Request`).
//!
//! ```console
//! $ echo "std_msgs/msg/Int32 cdr>ros1 0001000007000000" | cargo run -p opendr-messages --example message_echo
//! 07000000
//! ```

use std::fmt::Write as _;
use std::io::{BufRead, Write, stdin, stdout};

use opendr_engine::{Error, Result};
use opendr_messages::{
    Message, MessageType, RosService, StdSrvsEmpty, StdSrvsSetBool, StdSrvsTrigger, WireFormat,
    cdr_from_message, message_from_cdr, message_from_ros1, ros1_from_message,
};
use serde::Serialize;
use serde::de::DeserializeOwned;

fn main() -> std::io::Result<()> {
    let mut out = stdout().lock();
    for line in stdin().lock().lines() {
        match echo(&line?) {
            Ok(bytes) => writeln!(out, "{}", hex(&bytes))?,
            Err(error) => writeln!(out, "error: {}", error.to_string().replace('\n', " "))?,
        }
        out.flush()?;
    }
    Ok(())
}

fn echo(line: &str) -> Result<Vec<u8>> {
    let mut words = line.splitn(3, ' ');
    let (Some(name), Some(wires), Some(digits)) = (words.next(), words.next(), words.next()) else {
        return Err(Error::invalid_input("a line must be TYPE WIRE HEX"));
    };
    let (from, to) = wires.split_once('>').unwrap_or((wires, wires));
    let (from, to) = (wire(from)?, wire(to)?);
    let bytes = bytes(digits)?;
    match name {
        "std_srvs/srv/Empty_Request" => again::<<StdSrvsEmpty as RosService>::Request>(from, to, &bytes),
        "std_srvs/srv/Empty_Response" => again::<<StdSrvsEmpty as RosService>::Response>(from, to, &bytes),
        "std_srvs/srv/SetBool_Request" => again::<<StdSrvsSetBool as RosService>::Request>(from, to, &bytes),
        "std_srvs/srv/SetBool_Response" => {
            again::<<StdSrvsSetBool as RosService>::Response>(from, to, &bytes)
        }
        "std_srvs/srv/Trigger_Request" => again::<<StdSrvsTrigger as RosService>::Request>(from, to, &bytes),
        "std_srvs/srv/Trigger_Response" => {
            again::<<StdSrvsTrigger as RosService>::Response>(from, to, &bytes)
        }
        _ => Message::from_bytes(name.parse::<MessageType>()?, from, &bytes)?.to_bytes(to),
    }
}

fn again<M: Serialize + DeserializeOwned>(from: WireFormat, to: WireFormat, bytes: &[u8]) -> Result<Vec<u8>> {
    let message: M = match from {
        WireFormat::Cdr => message_from_cdr(bytes)?,
        WireFormat::Ros1 => message_from_ros1(bytes)?,
    };
    match to {
        WireFormat::Cdr => cdr_from_message(&message),
        WireFormat::Ros1 => ros1_from_message(&message),
    }
}

fn wire(name: &str) -> Result<WireFormat> {
    match name {
        "cdr" => Ok(WireFormat::Cdr),
        "ros1" => Ok(WireFormat::Ros1),
        _ => Err(Error::invalid_input(format!("no wire {name:?}; there are cdr and ros1"))),
    }
}

fn bytes(digits: &str) -> Result<Vec<u8>> {
    let digit = |byte: u8| char::from(byte).to_digit(16).and_then(|digit| u8::try_from(digit).ok());
    let pairs = digits.as_bytes().chunks(2).map(|pair| match *pair {
        [high, low] => Some(digit(high)? << 4 | digit(low)?),
        _ => None,
    });
    pairs
        .collect::<Option<_>>()
        .ok_or_else(|| Error::invalid_input("an odd number of digits, or not hexadecimal"))
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().fold(String::with_capacity(2 * bytes.len()), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}
