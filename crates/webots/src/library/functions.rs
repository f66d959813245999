//! The functions of `libController` that are used.

use std::ffi::{c_char, c_double, c_float, c_int, c_uchar, c_ushort, c_void};
use std::path::Path;

use libloading::Library;
use opendr_engine::{Error, Result};

/// A device in `libController`: its number.
pub(super) type Tag = c_ushort;
/// A node or field in `libController`.
pub(super) type Pointer = *mut c_void;

macro_rules! functions {
    ($($name:ident($($argument:ty),*) $(-> $result:ty)?;)*) => {
        /// The functions, named as in Webots' headers without `wb_`.
        pub(super) struct Functions {
            $(pub $name: unsafe extern "C" fn($($argument),*) $(-> $result)?,)*
            /// Last, so that it outlives the functions.
            _library: Library,
        }

        impl Functions {
            /// Loads the library and finds all functions.
            pub fn load(path: &Path) -> Result<Self> {
                // SAFETY: the user names the library of their Webots, whose initialisers run as in every controller.
                let library = unsafe { Library::new(path) }.map_err(|error| {
                    Error::not_found(format!("cannot load {}; set WEBOTS_HOME to the folder of Webots", path.display()))
                        .with_source(error)
                })?;
                Ok(Self {
                    $($name: {
                        let name = concat!("wb_", stringify!($name));
                        // SAFETY: the signatures are those of the headers, which R2023a to R2025a have in common.
                        let found = unsafe { library.get(name) };
                        *found.map_err(|error| {
                            Error::unsupported(format!("{} has no function {name}; it is too old", path.display()))
                                .with_source(error)
                        })?
                    },)*
                    _library: library,
                })
            }
        }
    };
}

functions! {
    robot_init() -> c_int;
    robot_step(c_int) -> c_int;
    robot_cleanup();
    robot_get_time() -> c_double;
    robot_get_name() -> *const c_char;
    robot_get_supervisor() -> bool;
    robot_get_basic_time_step() -> c_double;
    robot_get_number_of_devices() -> c_int;
    robot_get_device_by_index(c_int) -> Tag;
    device_get_name(Tag) -> *const c_char;
    device_get_model(Tag) -> *const c_char;
    device_get_node_type(Tag) -> c_int;
    node_get_name(c_int) -> *const c_char;
    motor_set_position(Tag, c_double);
    motor_set_velocity(Tag, c_double);
    motor_set_force(Tag, c_double);
    motor_enable_force_feedback(Tag, c_int);
    motor_get_force_feedback(Tag) -> c_double;
    motor_get_min_position(Tag) -> c_double;
    motor_get_max_position(Tag) -> c_double;
    motor_get_max_velocity(Tag) -> c_double;
    motor_get_max_force(Tag) -> c_double;
    position_sensor_enable(Tag, c_int);
    position_sensor_get_value(Tag) -> c_double;
    distance_sensor_enable(Tag, c_int);
    distance_sensor_get_value(Tag) -> c_double;
    distance_sensor_get_min_value(Tag) -> c_double;
    distance_sensor_get_max_value(Tag) -> c_double;
    gps_enable(Tag, c_int);
    gps_get_values(Tag) -> *const c_double;
    gps_get_speed(Tag) -> c_double;
    gps_get_speed_vector(Tag) -> *const c_double;
    inertial_unit_enable(Tag, c_int);
    inertial_unit_get_quaternion(Tag) -> *const c_double;
    accelerometer_enable(Tag, c_int);
    accelerometer_get_values(Tag) -> *const c_double;
    gyro_enable(Tag, c_int);
    gyro_get_values(Tag) -> *const c_double;
    compass_enable(Tag, c_int);
    compass_get_values(Tag) -> *const c_double;
    camera_enable(Tag, c_int);
    camera_get_image(Tag) -> *const c_uchar;
    camera_get_width(Tag) -> c_int;
    camera_get_height(Tag) -> c_int;
    range_finder_enable(Tag, c_int);
    range_finder_get_range_image(Tag) -> *const c_float;
    range_finder_get_width(Tag) -> c_int;
    range_finder_get_height(Tag) -> c_int;
    range_finder_get_min_range(Tag) -> c_double;
    range_finder_get_max_range(Tag) -> c_double;
    lidar_enable(Tag, c_int);
    lidar_get_range_image(Tag) -> *const c_float;
    lidar_get_horizontal_resolution(Tag) -> c_int;
    lidar_get_number_of_layers(Tag) -> c_int;
    lidar_get_min_range(Tag) -> c_double;
    lidar_get_max_range(Tag) -> c_double;
    emitter_send(Tag, *const c_void, c_int) -> c_int;
    receiver_enable(Tag, c_int);
    receiver_get_queue_length(Tag) -> c_int;
    receiver_get_data_size(Tag) -> c_int;
    receiver_get_data(Tag) -> *const c_void;
    receiver_next_packet(Tag);
    supervisor_simulation_reset();
    supervisor_node_get_from_def(*const c_char) -> Pointer;
    supervisor_node_get_field(Pointer, *const c_char) -> Pointer;
    supervisor_node_get_position(Pointer) -> *const c_double;
    supervisor_node_get_velocity(Pointer) -> *const c_double;
    supervisor_node_set_velocity(Pointer, *const c_double);
    supervisor_node_reset_physics(Pointer);
    supervisor_field_get_type(Pointer) -> c_int;
    supervisor_field_get_sf_bool(Pointer) -> bool;
    supervisor_field_get_sf_int32(Pointer) -> c_int;
    supervisor_field_get_sf_float(Pointer) -> c_double;
    supervisor_field_get_sf_vec2f(Pointer) -> *const c_double;
    supervisor_field_get_sf_vec3f(Pointer) -> *const c_double;
    supervisor_field_get_sf_rotation(Pointer) -> *const c_double;
    supervisor_field_get_sf_color(Pointer) -> *const c_double;
    supervisor_field_get_sf_string(Pointer) -> *const c_char;
    supervisor_field_set_sf_bool(Pointer, bool);
    supervisor_field_set_sf_int32(Pointer, c_int);
    supervisor_field_set_sf_float(Pointer, c_double);
    supervisor_field_set_sf_vec2f(Pointer, *const c_double);
    supervisor_field_set_sf_vec3f(Pointer, *const c_double);
    supervisor_field_set_sf_rotation(Pointer, *const c_double);
    supervisor_field_set_sf_color(Pointer, *const c_double);
    supervisor_field_set_sf_string(Pointer, *const c_char);
}
