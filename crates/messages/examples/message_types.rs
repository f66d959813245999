//! Prints every message type and service as a line of JSON: names, md5 sum, RIHS01 hash and definitions.
//!
//! ```console
//! $ cargo run -p opendr-messages --example message_types
//! ```

use opendr_messages::{MessageType, RosService, Wire};
use serde_json::json;

fn service<S: RosService>() {
    let (package, name) = (S::PACKAGE, S::NAME);
    println!(
        "{}",
        json!({"service": format!("{package}/srv/{name}"), "md5sum": S::MD5SUM, "rihs01": S::RIHS01})
    );
}

fn main() -> opendr_engine::Result<()> {
    for message in MessageType::ALL {
        let ros1 = message.ros1();
        println!(
            "{}",
            json!({
                "message": message.ros2_name(),
                "rihs01": message.rihs01(),
                "definition": message.definition(Wire::Cdr)?,
                "ros1": ros1.map(|known| known.name),
                "md5sum": ros1.map(|known| known.md5sum),
                "ros1_definition": message.definition(Wire::Ros1).ok(),
            })
        );
    }
    service::<opendr_messages::StdSrvsEmpty>();
    service::<opendr_messages::StdSrvsSetBool>();
    service::<opendr_messages::StdSrvsTrigger>();
    Ok(())
}
