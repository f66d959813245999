//! The byte layout of both configurations, of measurements and of requests.

use super::peer::{OLD, Peer, STATED, golden};
use crate::link::{MotorCommand, StepEnd, WebotsLink as _};
use crate::native::answer::Framing;
use crate::native::client::NativeLink;
use crate::version::Version;

#[test]
fn both_layouts_are_byte_for_byte_those_of_the_table() {
    for (text, version) in [(OLD, Version::R2023a), (STATED, Version::R2025a)] {
        let (peer, sent) = Peer::new(golden(text, '<'));
        let mut link = NativeLink::over(peer, Framing::Tcp, Some(version)).unwrap();
        assert_eq!((link.robot().name.as_str(), link.robot().basic_step_ms), ("robot", 16));
        assert_eq!((link.robot.world.as_str(), link.time()), ("/world.wbt", 0.5));
        for device in (0..13).filter(|device| *device != 11) {
            link.enable(device, 16).unwrap();
        }
        link.command(0, MotorCommand::Velocity(2.5)).unwrap();
        link.send(11, b"hi").unwrap();
        assert_eq!(link.step(16).unwrap(), StepEnd::Running);
        assert_eq!(link.time(), 0.516);
        let expected: [(usize, &[f64]); 8] = [
            (0, &[0.5]),
            (1, &[0.25]),
            (2, &[123.5]),
            (6, &[1.0, 2.0, 3.0, 9.0, 4.0, 5.0, 6.0]),
            (7, &[0.0, 0.0, 0.0, 1.0]),
            (8, &[10.0, 11.0, 12.0]),
            (9, &[20.0, 21.0, 22.0]),
            (10, &[30.0, 31.0, 32.0]),
        ];
        for (device, numbers) in expected {
            let mut values = vec![0.0; numbers.len()];
            link.values(device, &mut values).unwrap();
            assert_eq!(values, numbers);
        }
        assert_eq!(link.image(3).unwrap(), [0, 1, 2, 3, 4, 5, 6, 7]);
        let ranges = |device: usize| {
            link.image(device).unwrap().as_chunks().0.iter().map(|four| f32::from_le_bytes(*four))
        };
        assert!(ranges(4).eq([0.25, 0.5, 0.75, f32::INFINITY]) && ranges(5).eq([1.0, 2.0, 3.0, 4.0]));
        let mut packet = Vec::new();
        assert!(link.receive(12, &mut packet).unwrap() && packet == b"ok");
        drop(link);
        assert_eq!(*sent.lock().unwrap(), golden(text, '>'), "{version}");
    }
}

#[test]
fn a_unix_socket_has_another_frame() {
    let tcp = golden(STATED, '<');
    // The first answer is one chunk: its 11 bytes of frame become the whole size.
    let size = i32::from_le_bytes(tcp[2..6].try_into().unwrap());
    let messages = &tcp[11..11 + size as usize];
    let answer = [&(size + 4).to_le_bytes(), messages].concat();
    let (peer, _) = Peer::new(answer);
    let link = NativeLink::over(peer, Framing::Ipc, None).unwrap();
    assert_eq!((link.version(), link.robot().devices.len()), (Version::R2025a, 13));
}
