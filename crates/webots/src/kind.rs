//! Kinds of devices.

use std::fmt;

macro_rules! kinds {
    ($($(#[$doc:meta])* $name:ident = $after:literal, $values:literal;)*) => {
        /// A kind of device that both links know; others are listed by their robots, but cannot be used.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub enum DeviceKind {
            $($(#[$doc])* $name,)*
        }

        impl DeviceKind {
            /// All kinds.
            pub const ALL: &[Self] = &[$(Self::$name),*];

            /// Returns the name of the node in a world file, such as `RotationalMotor`.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$name => stringify!($name),)*
                }
            }

            /// Returns the number of values of a sensor that measures numbers; 0 for other devices.
            pub const fn values(self) -> usize {
                match self {
                    $(Self::$name => $values,)*
                }
            }

            /// Returns by how much the node number exceeds that of a robot: the devices follow it in one order in every version.
            pub(crate) const fn after_robot(self) -> u16 {
                match self {
                    $(Self::$name => $after,)*
                }
            }
        }
    };
}

kinds! {
    /// Acceleration without gravity's compensation, x, y, z in m/s^2.
    Accelerometer = 1, 3;
    /// A colour image.
    Camera = 4, 0;
    /// Direction of north, x, y, z.
    Compass = 5, 3;
    /// Distance, through the sensor's table.
    DistanceSensor = 8, 1;
    /// Sends packets.
    Emitter = 9, 0;
    /// Position (m), speed (m/s), velocity (m/s): 7 numbers.
    Gps = 10, 7;
    /// Angular velocity, x, y, z in rad/s.
    Gyro = 11, 3;
    /// Orientation as a quaternion x, y, z, w.
    InertialUnit = 12, 4;
    /// Ranges of several layers, in m.
    Lidar = 14, 0;
    /// A motor of a slider joint.
    LinearMotor = 16, 0;
    /// Position of a joint, in rad or m.
    PositionSensor = 18, 1;
    /// A depth image, in m.
    RangeFinder = 21, 0;
    /// Receives packets.
    Receiver = 22, 0;
    /// A motor of a hinge joint.
    RotationalMotor = 23, 0;
}

impl DeviceKind {
    /// Returns the kind with this node name; older versions call the nodes GPS and LIDAR in capitals.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|kind| kind.name().eq_ignore_ascii_case(name))
    }

    /// Returns whether this is a motor.
    pub const fn is_motor(self) -> bool {
        matches!(self, Self::LinearMotor | Self::RotationalMotor)
    }

    /// Returns whether this device measures ranges or takes images.
    pub const fn is_imager(self) -> bool {
        matches!(self, Self::Camera | Self::Lidar | Self::RangeFinder)
    }
}

impl fmt::Display for DeviceKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
