//! The messages, one module a package.

// Made by `cargo xtask generate` from the definitions in `msg/` and `ros1/`: not edited by hand.

pub mod audio_common_msgs;
pub mod builtin_interfaces;
pub mod diagnostic_msgs;
pub mod geometry_msgs;
pub mod lifecycle_msgs;
pub mod nav_msgs;
pub mod opendr_msgs;
pub mod rcl_interfaces;
pub mod ros1;
pub mod rosgraph_msgs;
pub mod sensor_msgs;
pub mod service_msgs;
pub mod std_msgs;
pub mod std_srvs;
pub mod tf2_msgs;
pub mod vision_msgs;
pub mod visualization_msgs;

messages! {
    AudioCommonMsgsAudioData(audio_common_msgs::AudioData) = "audio_common_msgs", "AudioData" {
        ros2: "RIHS01_a9742fba1567e649bbdba6ae034a72c7ef129b97c7a4da50fd2f3e1bfd8ffa86", "uint8[] data\n", [];
        ros1: same() "audio_common_msgs/AudioData", "f43a8e1b362b75baa741461b46adc7e0", "uint8[] data\n", [];
    }
    AudioCommonMsgsAudioDataStamped(audio_common_msgs::AudioDataStamped) = "audio_common_msgs", "AudioDataStamped" header {
        ros2: "RIHS01_6fc679d5a868ed68e4d301f1ef42abecc86140afb57d255656ff2d9e476ea9e3", "std_msgs/Header header\naudio_common_msgs/AudioData audio\n", ["audio_common_msgs/AudioData", "builtin_interfaces/Time", "std_msgs/Header"];
        ros1: same() "audio_common_msgs/AudioDataStamped", "3cdd84a06846af0dca4d0434908f9d96", "std_msgs/Header header\naudio_common_msgs/AudioData audio\n", ["audio_common_msgs/AudioData", "std_msgs/Header"];
    }
    AudioCommonMsgsAudioInfo(audio_common_msgs::AudioInfo) = "audio_common_msgs", "AudioInfo" {
        ros2: "RIHS01_b3494d204e513d2cceefae1888e5be3da7c8c8ca31eb277f7b5b62f364bcb1fb", "uint8 channels\nuint32 sample_rate\nstring sample_format\nuint32 bitrate\nstring coding_format\n", [];
        ros1: same() "audio_common_msgs/AudioInfo", "9413d9b7029680d3b1db6ed0ae535f88", "uint8 channels\nuint32 sample_rate\nstring sample_format\nuint32 bitrate\nstring coding_format\n", [];
    }
    BuiltinInterfacesDuration(builtin_interfaces::Duration) = "builtin_interfaces", "Duration" {
        ros2: "RIHS01_e8d009f659816f758b75334ee1a9ca5b5c0b859843261f14c7f937349599d93b", "int32 sec\nuint32 nanosec\n", [];
    }
    BuiltinInterfacesTime(builtin_interfaces::Time) = "builtin_interfaces", "Time" {
        ros2: "RIHS01_b106235e25a4c5ed35098aa0a61a3ee9c9b18d197f398b0e4206cea9acf9c197", "int32 sec\nuint32 nanosec\n", [];
    }
    DiagnosticMsgsDiagnosticArray(diagnostic_msgs::DiagnosticArray) = "diagnostic_msgs", "DiagnosticArray" header {
        ros2: "RIHS01_5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e", "std_msgs/Header header\ndiagnostic_msgs/DiagnosticStatus[] status\n", ["builtin_interfaces/Time", "diagnostic_msgs/DiagnosticStatus", "diagnostic_msgs/KeyValue", "std_msgs/Header"];
        ros1: same() "diagnostic_msgs/DiagnosticArray", "60810da900de1dd6ddd437c3503511da", "std_msgs/Header header\ndiagnostic_msgs/DiagnosticStatus[] status\n", ["diagnostic_msgs/DiagnosticStatus", "diagnostic_msgs/KeyValue", "std_msgs/Header"];
    }
    DiagnosticMsgsDiagnosticStatus(diagnostic_msgs::DiagnosticStatus) = "diagnostic_msgs", "DiagnosticStatus" {
        ros2: "RIHS01_b0e3e692ea2d54a8af2f4ef1930e81556a2db55216b771f8a7d2724ed47bf0e4", "byte OK=0\nbyte WARN=1\nbyte ERROR=2\nbyte STALE=3\nbyte level\nstring name\nstring message\nstring hardware_id\ndiagnostic_msgs/KeyValue[] values\n", ["diagnostic_msgs/KeyValue"];
        ros1: same() "diagnostic_msgs/DiagnosticStatus", "d0ce08bc6e5ba34c7754f563a9cabaf1", "byte OK=0\nbyte WARN=1\nbyte ERROR=2\nbyte STALE=3\nbyte level\nstring name\nstring message\nstring hardware_id\ndiagnostic_msgs/KeyValue[] values\n", ["diagnostic_msgs/KeyValue"];
    }
    DiagnosticMsgsKeyValue(diagnostic_msgs::KeyValue) = "diagnostic_msgs", "KeyValue" {
        ros2: "RIHS01_d68081eaa540288c5440753baecef0c4e16e81a5f78ad68902ded5100413bb42", "string key\nstring value\n", [];
        ros1: same() "diagnostic_msgs/KeyValue", "cf57fdc6617a881a88c16e768132149c", "string key\nstring value\n", [];
    }
    GeometryMsgsPoint(geometry_msgs::Point) = "geometry_msgs", "Point" {
        ros2: "RIHS01_6963084842a9b04494d6b2941d11444708d892da2f4b09843b9c43f42a7f6881", "float64 x\nfloat64 y\nfloat64 z\n", [];
        ros1: same() "geometry_msgs/Point", "4a842b65f413084dc2b10fb484ea7f17", "float64 x\nfloat64 y\nfloat64 z\n", [];
    }
    GeometryMsgsPoint32(geometry_msgs::Point32) = "geometry_msgs", "Point32" {
        ros2: "RIHS01_2fc4db7cae16a4582c79a56b66173a8d48d52c7dc520ddc55a0d4bcf2a4bfdbc", "float32 x\nfloat32 y\nfloat32 z\n", [];
        ros1: same() "geometry_msgs/Point32", "cc153912f1453b708d221682bc23d9ac", "float32 x\nfloat32 y\nfloat32 z\n", [];
    }
    GeometryMsgsPose(geometry_msgs::Pose) = "geometry_msgs", "Pose" {
        ros2: "RIHS01_d501954e9476cea2996984e812054b68026ae0bfae789d9a10b23daf35cc90fa", "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n", ["geometry_msgs/Point", "geometry_msgs/Quaternion"];
        ros1: same() "geometry_msgs/Pose", "e45d45a5a1ce597b249e23fb30fc871f", "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n", ["geometry_msgs/Point", "geometry_msgs/Quaternion"];
    }
    GeometryMsgsPose2D(geometry_msgs::Pose2D) = "geometry_msgs", "Pose2D" {
        ros2: "RIHS01_d68efa5b46e70f7b16ca23085474fdac5a44b638783ec42f661da64da4724ccc", "float64 x\nfloat64 y\nfloat64 theta\n", [];
        ros1: same() "geometry_msgs/Pose2D", "938fa65709584ad8e77d238529be13b8", "float64 x\nfloat64 y\nfloat64 theta\n", [];
    }
    GeometryMsgsPoseArray(geometry_msgs::PoseArray) = "geometry_msgs", "PoseArray" header {
        ros2: "RIHS01_af0cc36d190e104d546d168d6b39df04fa4b4ccecf59cb4c9ed328d3d5004aa0", "std_msgs/Header header\ngeometry_msgs/Pose[] poses\n", ["builtin_interfaces/Time", "geometry_msgs/Point", "geometry_msgs/Pose", "geometry_msgs/Quaternion", "std_msgs/Header"];
        ros1: same() "geometry_msgs/PoseArray", "916c28c5764443f268b296bb671b9d97", "std_msgs/Header header\ngeometry_msgs/Pose[] poses\n", ["geometry_msgs/Point", "geometry_msgs/Pose", "geometry_msgs/Quaternion", "std_msgs/Header"];
    }
    GeometryMsgsPoseStamped(geometry_msgs::PoseStamped) = "geometry_msgs", "PoseStamped" header {
        ros2: "RIHS01_10f3786d7d40fd2b54367835614bff85d4ad3b5dab62bf8bca0cc232d73b4cd8", "std_msgs/Header header\ngeometry_msgs/Pose pose\n", ["builtin_interfaces/Time", "geometry_msgs/Point", "geometry_msgs/Pose", "geometry_msgs/Quaternion", "std_msgs/Header"];
        ros1: same() "geometry_msgs/PoseStamped", "d3812c3cbc69362b77dc0b19b345f8f5", "std_msgs/Header header\ngeometry_msgs/Pose pose\n", ["geometry_msgs/Point", "geometry_msgs/Pose", "geometry_msgs/Quaternion", "std_msgs/Header"];
    }
    GeometryMsgsPoseWithCovariance(geometry_msgs::PoseWithCovariance) = "geometry_msgs", "PoseWithCovariance" {
        ros2: "RIHS01_9a7c0fd234b7f45c6098745ecccd773ca1085670e64107135397aee31c02e1bb", "geometry_msgs/Pose pose\nfloat64[36] covariance\n", ["geometry_msgs/Point", "geometry_msgs/Pose", "geometry_msgs/Quaternion"];
        ros1: same() "geometry_msgs/PoseWithCovariance", "c23e848cf1b7533a8d7c259073a97e6f", "geometry_msgs/Pose pose\nfloat64[36] covariance\n", ["geometry_msgs/Point", "geometry_msgs/Pose", "geometry_msgs/Quaternion"];
    }
    GeometryMsgsPoseWithCovarianceStamped(geometry_msgs::PoseWithCovarianceStamped) = "geometry_msgs", "PoseWithCovarianceStamped" header {
        ros2: "RIHS01_26432f9803e43727d3c8f668d1fdb3c630f548af631e2f4e31382371bfea3b6e", "std_msgs/Header header\ngeometry_msgs/PoseWithCovariance pose\n", ["builtin_interfaces/Time", "geometry_msgs/Point", "geometry_msgs/Pose", "geometry_msgs/PoseWithCovariance", "geometry_msgs/Quaternion", "std_msgs/Header"];
        ros1: same() "geometry_msgs/PoseWithCovarianceStamped", "953b798c0f514ff060a53a3498ce6246", "std_msgs/Header header\ngeometry_msgs/PoseWithCovariance pose\n", ["geometry_msgs/Point", "geometry_msgs/Pose", "geometry_msgs/PoseWithCovariance", "geometry_msgs/Quaternion", "std_msgs/Header"];
    }
    GeometryMsgsQuaternion(geometry_msgs::Quaternion) = "geometry_msgs", "Quaternion" {
        ros2: "RIHS01_8a765f66778c8ff7c8ab94afcc590a2ed5325a1d9a076ffff38fbce36f458684", "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n", [];
        ros1: same() "geometry_msgs/Quaternion", "a779879fadf0160734f906b8c19c7004", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n", [];
    }
    GeometryMsgsTransform(geometry_msgs::Transform) = "geometry_msgs", "Transform" {
        ros2: "RIHS01_beb83fbe698636351461f6f35d1abb20010c43d55374d81bd041f1ba2581fddc", "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n", ["geometry_msgs/Quaternion", "geometry_msgs/Vector3"];
        ros1: same() "geometry_msgs/Transform", "ac9eff44abf714214112b05d54a3cf9b", "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n", ["geometry_msgs/Quaternion", "geometry_msgs/Vector3"];
    }
    GeometryMsgsTransformStamped(geometry_msgs::TransformStamped) = "geometry_msgs", "TransformStamped" header {
        ros2: "RIHS01_0a241f87d04668d94099cbb5ba11691d5ad32c2f29682e4eb5653424bd275206", "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n", ["builtin_interfaces/Time", "geometry_msgs/Quaternion", "geometry_msgs/Transform", "geometry_msgs/Vector3", "std_msgs/Header"];
        ros1: same() "geometry_msgs/TransformStamped", "b5764a33bfeb3588febc2682852579b0", "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n", ["geometry_msgs/Quaternion", "geometry_msgs/Transform", "geometry_msgs/Vector3", "std_msgs/Header"];
    }
    GeometryMsgsTwist(geometry_msgs::Twist) = "geometry_msgs", "Twist" {
        ros2: "RIHS01_9c45bf16fe0983d80e3cfe750d6835843d265a9a6c46bd2e609fcddde6fb8d2a", "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n", ["geometry_msgs/Vector3"];
        ros1: same() "geometry_msgs/Twist", "9f195f881246fdfa2798d1d3eebca84a", "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n", ["geometry_msgs/Vector3"];
    }
    GeometryMsgsTwistStamped(geometry_msgs::TwistStamped) = "geometry_msgs", "TwistStamped" header {
        ros2: "RIHS01_5f0fcd4f81d5d06ad9b4c4c63e3ea51b82d6ae4d0558f1d475229b1121db6f64", "std_msgs/Header header\ngeometry_msgs/Twist twist\n", ["builtin_interfaces/Time", "geometry_msgs/Twist", "geometry_msgs/Vector3", "std_msgs/Header"];
        ros1: same() "geometry_msgs/TwistStamped", "98d34b0043a2093cf9d9345ab6eef12e", "std_msgs/Header header\ngeometry_msgs/Twist twist\n", ["geometry_msgs/Twist", "geometry_msgs/Vector3", "std_msgs/Header"];
    }
    GeometryMsgsTwistWithCovariance(geometry_msgs::TwistWithCovariance) = "geometry_msgs", "TwistWithCovariance" {
        ros2: "RIHS01_49f574f033f095d8b6cd1beaca5ca7925e296e84af1716d16c89d38b059c8c18", "geometry_msgs/Twist twist\nfloat64[36] covariance\n", ["geometry_msgs/Twist", "geometry_msgs/Vector3"];
        ros1: same() "geometry_msgs/TwistWithCovariance", "1fe8a28e6890a4cc3ae4c3ca5c7d82e6", "geometry_msgs/Twist twist\nfloat64[36] covariance\n", ["geometry_msgs/Twist", "geometry_msgs/Vector3"];
    }
    GeometryMsgsVector3(geometry_msgs::Vector3) = "geometry_msgs", "Vector3" {
        ros2: "RIHS01_cc12fe83e4c02719f1ce8070bfd14aecd40f75a96696a67a2a1f37f7dbb0765d", "float64 x\nfloat64 y\nfloat64 z\n", [];
        ros1: same() "geometry_msgs/Vector3", "4a842b65f413084dc2b10fb484ea7f17", "float64 x\nfloat64 y\nfloat64 z\n", [];
    }
    GeometryMsgsVector3Stamped(geometry_msgs::Vector3Stamped) = "geometry_msgs", "Vector3Stamped" header {
        ros2: "RIHS01_d4829622288cbb443886e7ea94ea5671a3b1be6bab4ad04224432a65f7d7887a", "std_msgs/Header header\ngeometry_msgs/Vector3 vector\n", ["builtin_interfaces/Time", "geometry_msgs/Vector3", "std_msgs/Header"];
        ros1: same() "geometry_msgs/Vector3Stamped", "7b324c7325e683bf02a9b14b01090ec7", "std_msgs/Header header\ngeometry_msgs/Vector3 vector\n", ["geometry_msgs/Vector3", "std_msgs/Header"];
    }
    LifecycleMsgsState(lifecycle_msgs::State) = "lifecycle_msgs", "State" {
        ros2: "RIHS01_dd2d02b82f3ebc858e53c431b1e6e91f3ffc71436fc81d0715214ac6ee2107a0", "uint8 PRIMARY_STATE_UNKNOWN=0\nuint8 PRIMARY_STATE_UNCONFIGURED=1\nuint8 PRIMARY_STATE_INACTIVE=2\nuint8 PRIMARY_STATE_ACTIVE=3\nuint8 PRIMARY_STATE_FINALIZED=4\nuint8 TRANSITION_STATE_CONFIGURING=10\nuint8 TRANSITION_STATE_CLEANINGUP=11\nuint8 TRANSITION_STATE_SHUTTINGDOWN=12\nuint8 TRANSITION_STATE_ACTIVATING=13\nuint8 TRANSITION_STATE_DEACTIVATING=14\nuint8 TRANSITION_STATE_ERRORPROCESSING=15\nuint8 id\nstring label\n", [];
    }
    LifecycleMsgsTransition(lifecycle_msgs::Transition) = "lifecycle_msgs", "Transition" {
        ros2: "RIHS01_c65d7b31ea134cba4f54fc867b817979be799f7452035cd35fac9b7421fb3424", "uint8 TRANSITION_CREATE=0\nuint8 TRANSITION_CONFIGURE=1\nuint8 TRANSITION_CLEANUP=2\nuint8 TRANSITION_ACTIVATE=3\nuint8 TRANSITION_DEACTIVATE=4\nuint8 TRANSITION_UNCONFIGURED_SHUTDOWN=5\nuint8 TRANSITION_INACTIVE_SHUTDOWN=6\nuint8 TRANSITION_ACTIVE_SHUTDOWN=7\nuint8 TRANSITION_DESTROY=8\nuint8 TRANSITION_ON_CONFIGURE_SUCCESS=10\nuint8 TRANSITION_ON_CONFIGURE_FAILURE=11\nuint8 TRANSITION_ON_CONFIGURE_ERROR=12\nuint8 TRANSITION_ON_CLEANUP_SUCCESS=20\nuint8 TRANSITION_ON_CLEANUP_FAILURE=21\nuint8 TRANSITION_ON_CLEANUP_ERROR=22\nuint8 TRANSITION_ON_ACTIVATE_SUCCESS=30\nuint8 TRANSITION_ON_ACTIVATE_FAILURE=31\nuint8 TRANSITION_ON_ACTIVATE_ERROR=32\nuint8 TRANSITION_ON_DEACTIVATE_SUCCESS=40\nuint8 TRANSITION_ON_DEACTIVATE_FAILURE=41\nuint8 TRANSITION_ON_DEACTIVATE_ERROR=42\nuint8 TRANSITION_ON_SHUTDOWN_SUCCESS=50\nuint8 TRANSITION_ON_SHUTDOWN_FAILURE=51\nuint8 TRANSITION_ON_SHUTDOWN_ERROR=52\nuint8 TRANSITION_ON_ERROR_SUCCESS=60\nuint8 TRANSITION_ON_ERROR_FAILURE=61\nuint8 TRANSITION_ON_ERROR_ERROR=62\nuint8 TRANSITION_CALLBACK_SUCCESS=97\nuint8 TRANSITION_CALLBACK_FAILURE=98\nuint8 TRANSITION_CALLBACK_ERROR=99\nuint8 id\nstring label\n", [];
    }
    LifecycleMsgsTransitionDescription(lifecycle_msgs::TransitionDescription) = "lifecycle_msgs", "TransitionDescription" {
        ros2: "RIHS01_c5f1cd4bb1ad2ba0e3329d4ac7015c52a674a72c1faf7974c37a33f4f6048b28", "lifecycle_msgs/Transition transition\nlifecycle_msgs/State start_state\nlifecycle_msgs/State goal_state\n", ["lifecycle_msgs/State", "lifecycle_msgs/Transition"];
    }
    LifecycleMsgsTransitionEvent(lifecycle_msgs::TransitionEvent) = "lifecycle_msgs", "TransitionEvent" {
        ros2: "RIHS01_d5f8873a2f0146498f812d7885c7327ce27e463d36811d8792f35ee38c0d6c38", "uint64 timestamp\nlifecycle_msgs/Transition transition\nlifecycle_msgs/State start_state\nlifecycle_msgs/State goal_state\n", ["lifecycle_msgs/State", "lifecycle_msgs/Transition"];
    }
    NavMsgsOdometry(nav_msgs::Odometry) = "nav_msgs", "Odometry" header {
        ros2: "RIHS01_3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0", "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\ngeometry_msgs/TwistWithCovariance twist\n", ["builtin_interfaces/Time", "geometry_msgs/Point", "geometry_msgs/Pose", "geometry_msgs/PoseWithCovariance", "geometry_msgs/Quaternion", "geometry_msgs/Twist", "geometry_msgs/TwistWithCovariance", "geometry_msgs/Vector3", "std_msgs/Header"];
        ros1: same() "nav_msgs/Odometry", "cd5e73d190d741a2f92e81eda573aca7", "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\ngeometry_msgs/TwistWithCovariance twist\n", ["geometry_msgs/Point", "geometry_msgs/Pose", "geometry_msgs/PoseWithCovariance", "geometry_msgs/Quaternion", "geometry_msgs/Twist", "geometry_msgs/TwistWithCovariance", "geometry_msgs/Vector3", "std_msgs/Header"];
    }
    NavMsgsPath(nav_msgs::Path) = "nav_msgs", "Path" header {
        ros2: "RIHS01_1957a5bb3cee5da65c4e52e52b65a93df227efce4c20f8458b36e73066ca334b", "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n", ["builtin_interfaces/Time", "geometry_msgs/Point", "geometry_msgs/Pose", "geometry_msgs/PoseStamped", "geometry_msgs/Quaternion", "std_msgs/Header"];
        ros1: same() "nav_msgs/Path", "6227e2b7e9cce15051f669a5e197bbf7", "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n", ["geometry_msgs/Point", "geometry_msgs/Pose", "geometry_msgs/PoseStamped", "geometry_msgs/Quaternion", "std_msgs/Header"];
    }
    OpendrMsgsAudioStamped(opendr_msgs::AudioStamped) = "opendr_msgs", "AudioStamped" header {
        ros2: "RIHS01_7fbe918a90f2cc1bcd138a30f045ce828f3654905be950dc7a00c270ce3627b5", "std_msgs/Header header\naudio_common_msgs/AudioInfo info\naudio_common_msgs/AudioData audio\n", ["audio_common_msgs/AudioData", "audio_common_msgs/AudioInfo", "builtin_interfaces/Time", "std_msgs/Header"];
        ros1: same() "opendr_msgs/AudioStamped", "56d82ccc42274d16c123bf86dc73c262", "std_msgs/Header header\naudio_common_msgs/AudioInfo info\naudio_common_msgs/AudioData audio\n", ["audio_common_msgs/AudioData", "audio_common_msgs/AudioInfo", "std_msgs/Header"];
    }
    OpendrMsgsCalibration(opendr_msgs::Calibration) = "opendr_msgs", "Calibration" header {
        ros2: "RIHS01_d427ce5fd8f9f152faf236d5bc5666bd9d80eee45e7d94d9d30c23e87f3c8292", "std_msgs/Header header\nfloat64[12] p2\nfloat64[9] r0_rect\nfloat64[12] tr_velo_to_cam\n", ["builtin_interfaces/Time", "std_msgs/Header"];
        ros1: same() "opendr_msgs/Calibration", "892eb0c4f558e5e199f42e34381f616d", "std_msgs/Header header\nfloat64[12] p2\nfloat64[9] r0_rect\nfloat64[12] tr_velo_to_cam\n", ["std_msgs/Header"];
    }
    OpendrMsgsFloat32MultiArrayStamped(opendr_msgs::Float32MultiArrayStamped) = "opendr_msgs", "Float32MultiArrayStamped" header {
        ros2: "RIHS01_5562c70904238e73699b200d5125a2fd9e969f5475328ff0fee30c8ea6ab9605", "std_msgs/Header header\nstd_msgs/Float32MultiArray array\n", ["builtin_interfaces/Time", "std_msgs/Float32MultiArray", "std_msgs/Header", "std_msgs/MultiArrayDimension", "std_msgs/MultiArrayLayout"];
        ros1: same() "opendr_msgs/Float32MultiArrayStamped", "46176703322494f6d3816a400517ea7d", "std_msgs/Header header\nstd_msgs/Float32MultiArray array\n", ["std_msgs/Float32MultiArray", "std_msgs/Header", "std_msgs/MultiArrayDimension", "std_msgs/MultiArrayLayout"];
    }
    OpendrMsgsImageWithDetections(opendr_msgs::ImageWithDetections) = "opendr_msgs", "ImageWithDetections" header {
        ros2: "RIHS01_81e4f95acd2d0b5a1f1053e34e6f28109b272673ee9e8076c880221f57afc768", "std_msgs/Header header\nsensor_msgs/Image image\nvision_msgs/Detection2DArray detections\n", ["builtin_interfaces/Time", "geometry_msgs/Point", "geometry_msgs/Pose", "geometry_msgs/PoseWithCovariance", "geometry_msgs/Quaternion", "sensor_msgs/Image", "std_msgs/Header", "vision_msgs/BoundingBox2D", "vision_msgs/Detection2D", "vision_msgs/Detection2DArray", "vision_msgs/ObjectHypothesis", "vision_msgs/ObjectHypothesisWithPose", "vision_msgs/Point2D", "vision_msgs/Pose2D"];
        ros1: own(ros1::opendr_msgs::ImageWithDetections) "opendr_msgs/ImageWithDetections", "6dbfc2757dbb21bdec0b1efc28f32224", "std_msgs/Header header\nsensor_msgs/Image image\nvision_msgs/Detection2DArray detections\n", ["geometry_msgs/Point", "geometry_msgs/Pose", "geometry_msgs/Pose2D", "geometry_msgs/PoseWithCovariance", "geometry_msgs/Quaternion", "sensor_msgs/Image", "std_msgs/Header", "vision_msgs/BoundingBox2D", "vision_msgs/Detection2D", "vision_msgs/Detection2DArray", "vision_msgs/ObjectHypothesisWithPose"];
    }
    OpendrMsgsObservation(opendr_msgs::Observation) = "opendr_msgs", "Observation" header {
        ros2: "RIHS01_f2b9f0983a0cc090e449bd6df5d8d74aedaa41513723bed9ea9881bff527ed6b", "std_msgs/Header header\nopendr_msgs/ObservationPart[] parts\n", ["builtin_interfaces/Time", "opendr_msgs/ObservationPart", "std_msgs/Float32MultiArray", "std_msgs/Header", "std_msgs/MultiArrayDimension", "std_msgs/MultiArrayLayout"];
        ros1: same() "opendr_msgs/Observation", "dfa086ec35d694870fece30abaf4f1fa", "std_msgs/Header header\nopendr_msgs/ObservationPart[] parts\n", ["opendr_msgs/ObservationPart", "std_msgs/Float32MultiArray", "std_msgs/Header", "std_msgs/MultiArrayDimension", "std_msgs/MultiArrayLayout"];
    }
    OpendrMsgsObservationPart(opendr_msgs::ObservationPart) = "opendr_msgs", "ObservationPart" {
        ros2: "RIHS01_46298aa30e313b2bbf1ed55272ed3af1bf44aaa68ad4a87e9ede3c144bf972ac", "string name\nstd_msgs/Float32MultiArray array\n", ["std_msgs/Float32MultiArray", "std_msgs/MultiArrayDimension", "std_msgs/MultiArrayLayout"];
        ros1: same() "opendr_msgs/ObservationPart", "9855b7a67c0663e4b98124c54ce0ff77", "string name\nstd_msgs/Float32MultiArray array\n", ["std_msgs/Float32MultiArray", "std_msgs/MultiArrayDimension", "std_msgs/MultiArrayLayout"];
    }
    OpendrMsgsPointCloudWithCalibration(opendr_msgs::PointCloudWithCalibration) = "opendr_msgs", "PointCloudWithCalibration" header {
        ros2: "RIHS01_b60f1230a8b799c24f0e67bc43a73849c37c0258cb78d4f0bf6fa4043e0f55b7", "std_msgs/Header header\nsensor_msgs/PointCloud2 cloud\nopendr_msgs/Calibration calibration\nuint32 image_height\nuint32 image_width\n", ["builtin_interfaces/Time", "opendr_msgs/Calibration", "sensor_msgs/PointCloud2", "sensor_msgs/PointField", "std_msgs/Header"];
        ros1: same() "opendr_msgs/PointCloudWithCalibration", "6187d38feda7c4a003dcd9d2c144fd5c", "std_msgs/Header header\nsensor_msgs/PointCloud2 cloud\nopendr_msgs/Calibration calibration\nuint32 image_height\nuint32 image_width\n", ["opendr_msgs/Calibration", "sensor_msgs/PointCloud2", "sensor_msgs/PointField", "std_msgs/Header"];
    }
    OpendrMsgsPose2D(opendr_msgs::Pose2D) = "opendr_msgs", "Pose2D" {
        ros2: "RIHS01_4c9d80e2b78776a9b86ecc443c18826569a99938bf7d1a747711fd2d01e3aa0b", "string skeleton\nopendr_msgs/Pose2DKeypoint[] keypoints\nfloat32 confidence\nint64 id\n", ["opendr_msgs/Pose2DKeypoint"];
        ros1: same() "opendr_msgs/Pose2D", "cfc027d49c4e0f58778d24ca65097978", "string skeleton\nopendr_msgs/Pose2DKeypoint[] keypoints\nfloat32 confidence\nint64 id\n", ["opendr_msgs/Pose2DKeypoint"];
    }
    OpendrMsgsPose2DArray(opendr_msgs::Pose2DArray) = "opendr_msgs", "Pose2DArray" header {
        ros2: "RIHS01_6ab8bacc3d2d4ec58f9a400d779595aaabba821c3d851038716961faaf1ab885", "std_msgs/Header header\nopendr_msgs/Pose2D[] poses\n", ["builtin_interfaces/Time", "opendr_msgs/Pose2D", "opendr_msgs/Pose2DKeypoint", "std_msgs/Header"];
        ros1: same() "opendr_msgs/Pose2DArray", "3ad1f6c8a5e6526f89905452c9cc9737", "std_msgs/Header header\nopendr_msgs/Pose2D[] poses\n", ["opendr_msgs/Pose2D", "opendr_msgs/Pose2DKeypoint", "std_msgs/Header"];
    }
    OpendrMsgsPose2DKeypoint(opendr_msgs::Pose2DKeypoint) = "opendr_msgs", "Pose2DKeypoint" {
        ros2: "RIHS01_80304b750850f5ec136c760188e878d97a55174ea2b2c4e4ad8b299c7cceedb9", "string name\nfloat32 x\nfloat32 y\nfloat32 confidence\n", [];
        ros1: same() "opendr_msgs/Pose2DKeypoint", "44da523a970b7ae73865e7610db408e6", "string name\nfloat32 x\nfloat32 y\nfloat32 confidence\n", [];
    }
    OpendrMsgsTextRegion(opendr_msgs::TextRegion) = "opendr_msgs", "TextRegion" {
        ros2: "RIHS01_1158f3f0f705d87e21b2c41843715b2e75df17171c1b8485664685934bf00752", "string text\nfloat32 confidence\nfloat32[8] corners\n", [];
        ros1: same() "opendr_msgs/TextRegion", "0c7818c01a4e0d418f58a3e627da193d", "string text\nfloat32 confidence\nfloat32[8] corners\n", [];
    }
    OpendrMsgsTextRegionArray(opendr_msgs::TextRegionArray) = "opendr_msgs", "TextRegionArray" header {
        ros2: "RIHS01_0d60f11f2bc7d2039a45cebba1654afe9207246c7a022842387287eb183bbf36", "std_msgs/Header header\nopendr_msgs/TextRegion[] regions\n", ["builtin_interfaces/Time", "opendr_msgs/TextRegion", "std_msgs/Header"];
        ros1: same() "opendr_msgs/TextRegionArray", "9323d6770e38cec90add04b4e2862424", "std_msgs/Header header\nopendr_msgs/TextRegion[] regions\n", ["opendr_msgs/TextRegion", "std_msgs/Header"];
    }
    OpendrMsgsTranscription(opendr_msgs::Transcription) = "opendr_msgs", "Transcription" header {
        ros2: "RIHS01_5ce95f0d0265560151f4ab2ca1c29ce41740d7b1d6d76205294c1c33341a0235", "std_msgs/Header header\nstring text\nstring language\nbool is_final\nopendr_msgs/TranscriptionSegment[] segments\n", ["builtin_interfaces/Time", "opendr_msgs/TranscriptionSegment", "std_msgs/Header"];
        ros1: same() "opendr_msgs/Transcription", "dec3d95c4a2e4dd88714c92768513810", "std_msgs/Header header\nstring text\nstring language\nbool is_final\nopendr_msgs/TranscriptionSegment[] segments\n", ["opendr_msgs/TranscriptionSegment", "std_msgs/Header"];
    }
    OpendrMsgsTranscriptionSegment(opendr_msgs::TranscriptionSegment) = "opendr_msgs", "TranscriptionSegment" {
        ros2: "RIHS01_7d75c19bdda43fba4803ca5a717ee573a566ada4837c76dc06c9f3e7442057b5", "int64 id\nint64 seek\nfloat32 start\nfloat32 end\nstring text\nint64[] tokens\nfloat32 temperature\nfloat32 avg_logprob\nfloat32 compression_ratio\nfloat32 no_speech_prob\n", [];
        ros1: same() "opendr_msgs/TranscriptionSegment", "5df61f8d4a327835f93a3236e5fa2388", "int64 id\nint64 seek\nfloat32 start\nfloat32 end\nstring text\nint64[] tokens\nfloat32 temperature\nfloat32 avg_logprob\nfloat32 compression_ratio\nfloat32 no_speech_prob\n", [];
    }
    OpendrMsgsViewAction(opendr_msgs::ViewAction) = "opendr_msgs", "ViewAction" header {
        ros2: "RIHS01_2140cb919ca9f30fc7bccae2a0bc414f57f6790dbf8b1c513129a4a7b2634604", "std_msgs/Header header\nfloat32[] axes\n", ["builtin_interfaces/Time", "std_msgs/Header"];
        ros1: same() "opendr_msgs/ViewAction", "6f37860e848b28e99bba05668b254b1d", "std_msgs/Header header\nfloat32[] axes\n", ["std_msgs/Header"];
    }
    RclInterfacesFloatingPointRange(rcl_interfaces::FloatingPointRange) = "rcl_interfaces", "FloatingPointRange" {
        ros2: "RIHS01_e6af23a23c177fee5f3075c8b1e435162a9b63c863d78c06017460b49684262d", "float64 from_value\nfloat64 to_value\nfloat64 step\n", [];
    }
    RclInterfacesIntegerRange(rcl_interfaces::IntegerRange) = "rcl_interfaces", "IntegerRange" {
        ros2: "RIHS01_f7b7fdc0f65f07702e099218e13288c3963bcb9345bde78b560e6cd19800fc5a", "int64 from_value\nint64 to_value\nuint64 step\n", [];
    }
    RclInterfacesListParametersResult(rcl_interfaces::ListParametersResult) = "rcl_interfaces", "ListParametersResult" {
        ros2: "RIHS01_237ae3428413dcbcfb452b510c42355f3a2b021dc091afa3e18526d57022f1cd", "string[] names\nstring[] prefixes\n", [];
    }
    RclInterfacesLog(rcl_interfaces::Log) = "rcl_interfaces", "Log" {
        ros2: "RIHS01_e28ce254ca8abc06abf92773b74602cdbf116ed34fbaf294fb9f81da9f318eac", "uint8 DEBUG=10\nuint8 INFO=20\nuint8 WARN=30\nuint8 ERROR=40\nuint8 FATAL=50\nbuiltin_interfaces/Time stamp\nuint8 level\nstring name\nstring msg\nstring file\nstring function\nuint32 line\n", ["builtin_interfaces/Time"];
    }
    RclInterfacesParameter(rcl_interfaces::Parameter) = "rcl_interfaces", "Parameter" {
        ros2: "RIHS01_ddfe6442cffc462317adb5c92536a7b6dd55858c5c3e1e328165a6b73c2831af", "string name\nrcl_interfaces/ParameterValue value\n", ["rcl_interfaces/ParameterValue"];
    }
    RclInterfacesParameterDescriptor(rcl_interfaces::ParameterDescriptor) = "rcl_interfaces", "ParameterDescriptor" {
        ros2: "RIHS01_52175dbfda6c51153101d33d2a9da05743f66f02d5ab2ca9ec4709b46b73d704", "string name\nuint8 type\nstring description\nstring additional_constraints\nbool read_only false\nbool dynamic_typing false\nrcl_interfaces/FloatingPointRange[<=1] floating_point_range\nrcl_interfaces/IntegerRange[<=1] integer_range\n", ["rcl_interfaces/FloatingPointRange", "rcl_interfaces/IntegerRange"];
    }
    RclInterfacesParameterEvent(rcl_interfaces::ParameterEvent) = "rcl_interfaces", "ParameterEvent" {
        ros2: "RIHS01_043e627780fcad87a22d225bc2a037361dba713fca6a6b9f4b869a5aa0393204", "builtin_interfaces/Time stamp\nstring node\nrcl_interfaces/Parameter[] new_parameters\nrcl_interfaces/Parameter[] changed_parameters\nrcl_interfaces/Parameter[] deleted_parameters\n", ["builtin_interfaces/Time", "rcl_interfaces/Parameter", "rcl_interfaces/ParameterValue"];
    }
    RclInterfacesParameterType(rcl_interfaces::ParameterType) = "rcl_interfaces", "ParameterType" {
        ros2: "RIHS01_df29ed057a834862187be24dd187d981790ff3ea6502f4cd27b432cbc42c6d46", "uint8 PARAMETER_NOT_SET=0\nuint8 PARAMETER_BOOL=1\nuint8 PARAMETER_INTEGER=2\nuint8 PARAMETER_DOUBLE=3\nuint8 PARAMETER_STRING=4\nuint8 PARAMETER_BYTE_ARRAY=5\nuint8 PARAMETER_BOOL_ARRAY=6\nuint8 PARAMETER_INTEGER_ARRAY=7\nuint8 PARAMETER_DOUBLE_ARRAY=8\nuint8 PARAMETER_STRING_ARRAY=9\n", [];
    }
    RclInterfacesParameterValue(rcl_interfaces::ParameterValue) = "rcl_interfaces", "ParameterValue" {
        ros2: "RIHS01_115fc089a387e23c7ecd3525c9189c379109119d6ab82e8dfbde0fdf6a7f9b68", "uint8 type\nbool bool_value\nint64 integer_value\nfloat64 double_value\nstring string_value\nbyte[] byte_array_value\nbool[] bool_array_value\nint64[] integer_array_value\nfloat64[] double_array_value\nstring[] string_array_value\n", [];
    }
    RclInterfacesSetParametersResult(rcl_interfaces::SetParametersResult) = "rcl_interfaces", "SetParametersResult" {
        ros2: "RIHS01_cfcc0fb0371ee5159b403960ef4300f8f9d2f1fd6117c8666b7f9654d528a9b1", "bool successful\nstring reason\n", [];
    }
    RosgraphMsgsClock(rosgraph_msgs::Clock) = "rosgraph_msgs", "Clock" {
        ros2: "RIHS01_692f7a66e93a3c83e71765d033b60349ba68023a8c689a79e48078bcb5c58564", "builtin_interfaces/Time clock\n", ["builtin_interfaces/Time"];
        ros1: same() "rosgraph_msgs/Clock", "a9c97c1d230cfc112e270351a944ee47", "time clock\n", [];
    }
    SensorMsgsCameraInfo(sensor_msgs::CameraInfo) = "sensor_msgs", "CameraInfo" header {
        ros2: "RIHS01_b3dfd68ff46c9d56c80fd3bd4ed22c7a4ddce8c8348f2f59c299e73118e7e275", "std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\nfloat64[] d\nfloat64[9] k\nfloat64[9] r\nfloat64[12] p\nuint32 binning_x\nuint32 binning_y\nsensor_msgs/RegionOfInterest roi\n", ["builtin_interfaces/Time", "sensor_msgs/RegionOfInterest", "std_msgs/Header"];
        ros1: same() "sensor_msgs/CameraInfo", "c9a58c1b0b154e0e6da7578cb991d214", "std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\nfloat64[] D\nfloat64[9] K\nfloat64[9] R\nfloat64[12] P\nuint32 binning_x\nuint32 binning_y\nsensor_msgs/RegionOfInterest roi\n", ["sensor_msgs/RegionOfInterest", "std_msgs/Header"];
    }
    SensorMsgsCompressedImage(sensor_msgs::CompressedImage) = "sensor_msgs", "CompressedImage" header {
        ros2: "RIHS01_15640771531571185e2efc8a100baf923961a4d15d5569652e6cb6691e8e371a", "std_msgs/Header header\nstring format\nuint8[] data\n", ["builtin_interfaces/Time", "std_msgs/Header"];
        ros1: same() "sensor_msgs/CompressedImage", "8f7a12909da2c9d3332d540a0977563f", "std_msgs/Header header\nstring format\nuint8[] data\n", ["std_msgs/Header"];
    }
    SensorMsgsImage(sensor_msgs::Image) = "sensor_msgs", "Image" header {
        ros2: "RIHS01_d31d41a9a4c4bc8eae9be757b0beed306564f7526c88ea6a4588fb9582527d47", "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\nuint32 step\nuint8[] data\n", ["builtin_interfaces/Time", "std_msgs/Header"];
        ros1: same() "sensor_msgs/Image", "060021388200f6f0f447d0fcd9c64743", "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\nuint32 step\nuint8[] data\n", ["std_msgs/Header"];
    }
    SensorMsgsImu(sensor_msgs::Imu) = "sensor_msgs", "Imu" header {
        ros2: "RIHS01_7d9a00ff131080897a5ec7e26e315954b8eae3353c3f995c55faf71574000b5b", "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance\ngeometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance\ngeometry_msgs/Vector3 linear_acceleration\nfloat64[9] linear_acceleration_covariance\n", ["builtin_interfaces/Time", "geometry_msgs/Quaternion", "geometry_msgs/Vector3", "std_msgs/Header"];
        ros1: same() "sensor_msgs/Imu", "6a62c6daae103f4ff57a132d6f95cec2", "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance\ngeometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance\ngeometry_msgs/Vector3 linear_acceleration\nfloat64[9] linear_acceleration_covariance\n", ["geometry_msgs/Quaternion", "geometry_msgs/Vector3", "std_msgs/Header"];
    }
    SensorMsgsJointState(sensor_msgs::JointState) = "sensor_msgs", "JointState" header {
        ros2: "RIHS01_a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e", "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n", ["builtin_interfaces/Time", "std_msgs/Header"];
        ros1: same() "sensor_msgs/JointState", "3066dcd76a6cfaef579bd0f34173e9fd", "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n", ["std_msgs/Header"];
    }
    SensorMsgsLaserScan(sensor_msgs::LaserScan) = "sensor_msgs", "LaserScan" header {
        ros2: "RIHS01_64c191398013af96509d518dac71d5164f9382553fce5c1f8cca5be7924bd828", "std_msgs/Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\nfloat32 time_increment\nfloat32 scan_time\nfloat32 range_min\nfloat32 range_max\nfloat32[] ranges\nfloat32[] intensities\n", ["builtin_interfaces/Time", "std_msgs/Header"];
        ros1: same() "sensor_msgs/LaserScan", "90c7ef2dc6895d81024acba2ac42f369", "std_msgs/Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\nfloat32 time_increment\nfloat32 scan_time\nfloat32 range_min\nfloat32 range_max\nfloat32[] ranges\nfloat32[] intensities\n", ["std_msgs/Header"];
    }
    SensorMsgsPointCloud2(sensor_msgs::PointCloud2) = "sensor_msgs", "PointCloud2" header {
        ros2: "RIHS01_9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5", "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\nbool is_bigendian\nuint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n", ["builtin_interfaces/Time", "sensor_msgs/PointField", "std_msgs/Header"];
        ros1: same() "sensor_msgs/PointCloud2", "1158d486dd51d683ce2f1be655c3c181", "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\nbool is_bigendian\nuint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n", ["sensor_msgs/PointField", "std_msgs/Header"];
    }
    SensorMsgsPointField(sensor_msgs::PointField) = "sensor_msgs", "PointField" {
        ros2: "RIHS01_5c6a4750728c2bcfbbf7037225b20b02d4429634732146b742dee1726637ef01", "uint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\nuint8 UINT16=4\nuint8 INT32=5\nuint8 UINT32=6\nuint8 FLOAT32=7\nuint8 FLOAT64=8\nstring name\nuint32 offset\nuint8 datatype\nuint32 count\n", [];
        ros1: same() "sensor_msgs/PointField", "268eacb2962780ceac86cbd17e328150", "uint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\nuint8 UINT16=4\nuint8 INT32=5\nuint8 UINT32=6\nuint8 FLOAT32=7\nuint8 FLOAT64=8\nstring name\nuint32 offset\nuint8 datatype\nuint32 count\n", [];
    }
    SensorMsgsRegionOfInterest(sensor_msgs::RegionOfInterest) = "sensor_msgs", "RegionOfInterest" {
        ros2: "RIHS01_ad16bcba5f9131dcdba6fbded19f726f5440e3c513b4fb586dd3027eeed8abb1", "uint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\nbool do_rectify\n", [];
        ros1: same() "sensor_msgs/RegionOfInterest", "bdb633039d588fcccb441a4d43ccfe09", "uint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\nbool do_rectify\n", [];
    }
    ServiceMsgsServiceEventInfo(service_msgs::ServiceEventInfo) = "service_msgs", "ServiceEventInfo" {
        ros2: "RIHS01_41bcbbe07a75c9b52bc96bfd5c24d7f0fc0a08c0cb7921b3373c5732345a6f45", "uint8 REQUEST_SENT=0\nuint8 REQUEST_RECEIVED=1\nuint8 RESPONSE_SENT=2\nuint8 RESPONSE_RECEIVED=3\nuint8 event_type\nbuiltin_interfaces/Time stamp\nchar[16] client_gid\nint64 sequence_number\n", ["builtin_interfaces/Time"];
    }
    StdMsgsBool(std_msgs::Bool) = "std_msgs", "Bool" {
        ros2: "RIHS01_feb91e995ff9ebd09c0cb3d2aed18b11077585839fb5db80193b62d74528f6c9", "bool data\n", [];
        ros1: same() "std_msgs/Bool", "8b94c1b53db61fb6aed406028ad6332a", "bool data\n", [];
    }
    StdMsgsColorRGBA(std_msgs::ColorRGBA) = "std_msgs", "ColorRGBA" {
        ros2: "RIHS01_77a7a5b9ae477306097665106e0413ba74440245b1f3d0c6d6405fe5c7813fe8", "float32 r\nfloat32 g\nfloat32 b\nfloat32 a\n", [];
        ros1: same() "std_msgs/ColorRGBA", "a29a96539573343b1310c73607334b00", "float32 r\nfloat32 g\nfloat32 b\nfloat32 a\n", [];
    }
    StdMsgsEmpty(std_msgs::Empty) = "std_msgs", "Empty" {
        ros2: "RIHS01_20b625256f32d5dbc0d04fee44f43c41e51c70d3502f84b4a08e7a9c26a96312", "", [];
        ros1: same() "std_msgs/Empty", "d41d8cd98f00b204e9800998ecf8427e", "", [];
    }
    StdMsgsFloat32(std_msgs::Float32) = "std_msgs", "Float32" {
        ros2: "RIHS01_7170d3d8f841f7be3172ce5f4f59f3a4d7f63b0447e8b33327601ad64d83d6e2", "float32 data\n", [];
        ros1: same() "std_msgs/Float32", "73fcbf46b49191e672908e50842a83d4", "float32 data\n", [];
    }
    StdMsgsFloat32MultiArray(std_msgs::Float32MultiArray) = "std_msgs", "Float32MultiArray" {
        ros2: "RIHS01_0599f6f85b4bfca379873a0b4375a0aca022156bd2d7021275d116ed1fa8bfe0", "std_msgs/MultiArrayLayout layout\nfloat32[] data\n", ["std_msgs/MultiArrayDimension", "std_msgs/MultiArrayLayout"];
        ros1: same() "std_msgs/Float32MultiArray", "6a40e0ffa6a17a503ac3f8616991b1f6", "std_msgs/MultiArrayLayout layout\nfloat32[] data\n", ["std_msgs/MultiArrayDimension", "std_msgs/MultiArrayLayout"];
    }
    StdMsgsFloat64(std_msgs::Float64) = "std_msgs", "Float64" {
        ros2: "RIHS01_705ba9c3d1a09df43737eb67095534de36fd426c0587779bda2bc51fe790182a", "float64 data\n", [];
        ros1: same() "std_msgs/Float64", "fdb28210bfa9d7c91146260178d9a584", "float64 data\n", [];
    }
    StdMsgsFloat64MultiArray(std_msgs::Float64MultiArray) = "std_msgs", "Float64MultiArray" {
        ros2: "RIHS01_1025ddc6b9552d191f89ef1a8d2f60f3d373e28b283d8891ddcc974e8c55397f", "std_msgs/MultiArrayLayout layout\nfloat64[] data\n", ["std_msgs/MultiArrayDimension", "std_msgs/MultiArrayLayout"];
        ros1: same() "std_msgs/Float64MultiArray", "4b7d974086d4060e7db4613a7e6c3ba4", "std_msgs/MultiArrayLayout layout\nfloat64[] data\n", ["std_msgs/MultiArrayDimension", "std_msgs/MultiArrayLayout"];
    }
    StdMsgsHeader(std_msgs::Header) = "std_msgs", "Header" {
        ros2: "RIHS01_f49fb3ae2cf070f793645ff749683ac6b06203e41c891e17701b1cb597ce6a01", "builtin_interfaces/Time stamp\nstring frame_id\n", ["builtin_interfaces/Time"];
        ros1: same() "std_msgs/Header", "2176decaecbce78abc3b96ef049fabed", "uint32 seq\ntime stamp\nstring frame_id\n", [];
    }
    StdMsgsInt32(std_msgs::Int32) = "std_msgs", "Int32" {
        ros2: "RIHS01_b6578ded3c58c626cfe8d1a6fb6e04f706f97e9f03d2727c9ff4e74b1cef0deb", "int32 data\n", [];
        ros1: same() "std_msgs/Int32", "da5909fbe378aeaf85e547e830cc1bb7", "int32 data\n", [];
    }
    StdMsgsInt32MultiArray(std_msgs::Int32MultiArray) = "std_msgs", "Int32MultiArray" {
        ros2: "RIHS01_84a7346323525d1b4dfca899df3820f245e54009dac5a6b69217d14fdefd1701", "std_msgs/MultiArrayLayout layout\nint32[] data\n", ["std_msgs/MultiArrayDimension", "std_msgs/MultiArrayLayout"];
        ros1: same() "std_msgs/Int32MultiArray", "1d99f79f8b325b44fee908053e9c945b", "std_msgs/MultiArrayLayout layout\nint32[] data\n", ["std_msgs/MultiArrayDimension", "std_msgs/MultiArrayLayout"];
    }
    StdMsgsInt64(std_msgs::Int64) = "std_msgs", "Int64" {
        ros2: "RIHS01_8cd1048c2f186b6bd9a92472dc1ce51723c0833a221e2b7aecfff111774f4b49", "int64 data\n", [];
        ros1: same() "std_msgs/Int64", "34add168574510e6e17f5d23ecc077ef", "int64 data\n", [];
    }
    StdMsgsMultiArrayDimension(std_msgs::MultiArrayDimension) = "std_msgs", "MultiArrayDimension" {
        ros2: "RIHS01_5e773a60a4c7fc8a54985f307c7837aa2994252a126c301957a24e31282c9cbe", "string label\nuint32 size\nuint32 stride\n", [];
        ros1: same() "std_msgs/MultiArrayDimension", "4cd0c83a8683deae40ecdac60e53bfa8", "string label\nuint32 size\nuint32 stride\n", [];
    }
    StdMsgsMultiArrayLayout(std_msgs::MultiArrayLayout) = "std_msgs", "MultiArrayLayout" {
        ros2: "RIHS01_4c66e6f78e740ac103a94cf63259f968e48c617e7699e829b63c21a5cb50dac6", "std_msgs/MultiArrayDimension[] dim\nuint32 data_offset\n", ["std_msgs/MultiArrayDimension"];
        ros1: same() "std_msgs/MultiArrayLayout", "0fed2a11c13e11c5571b4e2a995a91a3", "std_msgs/MultiArrayDimension[] dim\nuint32 data_offset\n", ["std_msgs/MultiArrayDimension"];
    }
    StdMsgsString(std_msgs::String) = "std_msgs", "String" {
        ros2: "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18", "string data\n", [];
        ros1: same() "std_msgs/String", "992ce8a1687cec8c8bd883ec73ca41d1", "string data\n", [];
    }
    StdMsgsUInt8MultiArray(std_msgs::UInt8MultiArray) = "std_msgs", "UInt8MultiArray" {
        ros2: "RIHS01_5687e861b8d307a5e48b7515467ae7a5fc2daf805bd0ce6d8e9e604bade9f385", "std_msgs/MultiArrayLayout layout\nuint8[] data\n", ["std_msgs/MultiArrayDimension", "std_msgs/MultiArrayLayout"];
        ros1: same() "std_msgs/UInt8MultiArray", "82373f1612381bb6ee473b5cd6f5d89c", "std_msgs/MultiArrayLayout layout\nuint8[] data\n", ["std_msgs/MultiArrayDimension", "std_msgs/MultiArrayLayout"];
    }
    Tf2MsgsTFMessage(tf2_msgs::TFMessage) = "tf2_msgs", "TFMessage" {
        ros2: "RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087", "geometry_msgs/TransformStamped[] transforms\n", ["builtin_interfaces/Time", "geometry_msgs/Quaternion", "geometry_msgs/Transform", "geometry_msgs/TransformStamped", "geometry_msgs/Vector3", "std_msgs/Header"];
        ros1: same() "tf2_msgs/TFMessage", "94810edda583a504dfda3829e70d7eec", "geometry_msgs/TransformStamped[] transforms\n", ["geometry_msgs/Quaternion", "geometry_msgs/Transform", "geometry_msgs/TransformStamped", "geometry_msgs/Vector3", "std_msgs/Header"];
    }
    VisionMsgsBoundingBox2D(vision_msgs::BoundingBox2D) = "vision_msgs", "BoundingBox2D" {
        ros2: "RIHS01_008eacbb0cf8f26e83795547bed013eec3675485ef386ec056d80eaaf1c1ce2f", "vision_msgs/Pose2D center\nfloat64 size_x\nfloat64 size_y\n", ["vision_msgs/Point2D", "vision_msgs/Pose2D"];
        ros1: own(ros1::vision_msgs::BoundingBox2D) "vision_msgs/BoundingBox2D", "9ab41e2a4c8627735e5091a9abd68b02", "geometry_msgs/Pose2D center\nfloat64 size_x\nfloat64 size_y\n", ["geometry_msgs/Pose2D"];
    }
    VisionMsgsBoundingBox2DArray(vision_msgs::BoundingBox2DArray) = "vision_msgs", "BoundingBox2DArray" header {
        ros2: "RIHS01_2464e82838009386d371b523211c21c91d74d313fcdd6788223c531d621cf691", "std_msgs/Header header\nvision_msgs/BoundingBox2D[] boxes\n", ["builtin_interfaces/Time", "std_msgs/Header", "vision_msgs/BoundingBox2D", "vision_msgs/Point2D", "vision_msgs/Pose2D"];
        ros1: own(ros1::vision_msgs::BoundingBox2DArray) "vision_msgs/BoundingBox2DArray", "583fadc917b98c913c8ed3ee2bf4514a", "std_msgs/Header header\nvision_msgs/BoundingBox2D[] boxes\n", ["geometry_msgs/Pose2D", "std_msgs/Header", "vision_msgs/BoundingBox2D"];
    }
    VisionMsgsBoundingBox3D(vision_msgs::BoundingBox3D) = "vision_msgs", "BoundingBox3D" {
        ros2: "RIHS01_bbb73a65c163d7f9bb29009c7bde9f7faa576bd2d23299c4511d19230dab4698", "geometry_msgs/Pose center\ngeometry_msgs/Vector3 size\n", ["geometry_msgs/Point", "geometry_msgs/Pose", "geometry_msgs/Quaternion", "geometry_msgs/Vector3"];
        ros1: same() "vision_msgs/BoundingBox3D", "727c83f2b037373b8e968433d9c84ecb", "geometry_msgs/Pose center\ngeometry_msgs/Vector3 size\n", ["geometry_msgs/Point", "geometry_msgs/Pose", "geometry_msgs/Quaternion", "geometry_msgs/Vector3"];
    }
    VisionMsgsBoundingBox3DArray(vision_msgs::BoundingBox3DArray) = "vision_msgs", "BoundingBox3DArray" header {
        ros2: "RIHS01_a81938db9576b10c2eecd7c5a5da3eac496efd00221b25ed051dfbc81fb56da6", "std_msgs/Header header\nvision_msgs/BoundingBox3D[] boxes\n", ["builtin_interfaces/Time", "geometry_msgs/Point", "geometry_msgs/Pose", "geometry_msgs/Quaternion", "geometry_msgs/Vector3", "std_msgs/Header", "vision_msgs/BoundingBox3D"];
        ros1: same() "vision_msgs/BoundingBox3DArray", "9e1a3932308592aa1b20232d818486db", "std_msgs/Header header\nvision_msgs/BoundingBox3D[] boxes\n", ["geometry_msgs/Point", "geometry_msgs/Pose", "geometry_msgs/Quaternion", "geometry_msgs/Vector3", "std_msgs/Header", "vision_msgs/BoundingBox3D"];
    }
    VisionMsgsClassification(vision_msgs::Classification) = "vision_msgs", "Classification" header {
        ros2: "RIHS01_f74db28d0eaef3afb78f48bf2161cd709a1383a0309d3454383b25be11345143", "std_msgs/Header header\nvision_msgs/ObjectHypothesis[] results\n", ["builtin_interfaces/Time", "std_msgs/Header", "vision_msgs/ObjectHypothesis"];
        ros1: own(ros1::vision_msgs::Classification2D) "vision_msgs/Classification2D", "b23d0855d0f41568e09106615351255f", "std_msgs/Header header\nvision_msgs/ObjectHypothesis[] results\nsensor_msgs/Image source_img\n", ["sensor_msgs/Image", "std_msgs/Header", "vision_msgs/ObjectHypothesis"];
    }
    VisionMsgsDetection2D(vision_msgs::Detection2D) = "vision_msgs", "Detection2D" header {
        ros2: "RIHS01_0d12b69df5c593b3455b7346fac8205437a7d4bcb09b9e0e0b2dde787ded38ea", "std_msgs/Header header\nvision_msgs/ObjectHypothesisWithPose[] results\nvision_msgs/BoundingBox2D bbox\nstring id\n", ["builtin_interfaces/Time", "geometry_msgs/Point", "geometry_msgs/Pose", "geometry_msgs/PoseWithCovariance", "geometry_msgs/Quaternion", "std_msgs/Header", "vision_msgs/BoundingBox2D", "vision_msgs/ObjectHypothesis", "vision_msgs/ObjectHypothesisWithPose", "vision_msgs/Point2D", "vision_msgs/Pose2D"];
        ros1: own(ros1::vision_msgs::Detection2D) "vision_msgs/Detection2D", "329cc1976fa8dfa4e20fca3a29145725", "std_msgs/Header header\nvision_msgs/ObjectHypothesisWithPose[] results\nvision_msgs/BoundingBox2D bbox\nsensor_msgs/Image source_img\nbool is_tracking\nstring tracking_id\n", ["geometry_msgs/Point", "geometry_msgs/Pose", "geometry_msgs/Pose2D", "geometry_msgs/PoseWithCovariance", "geometry_msgs/Quaternion", "sensor_msgs/Image", "std_msgs/Header", "vision_msgs/BoundingBox2D", "vision_msgs/ObjectHypothesisWithPose"];
    }
    VisionMsgsDetection2DArray(vision_msgs::Detection2DArray) = "vision_msgs", "Detection2DArray" header {
        ros2: "RIHS01_214274120007f4a683866481336b70310268cfa107aebe9d594a6acf75bda968", "std_msgs/Header header\nvision_msgs/Detection2D[] detections\n", ["builtin_interfaces/Time", "geometry_msgs/Point", "geometry_msgs/Pose", "geometry_msgs/PoseWithCovariance", "geometry_msgs/Quaternion", "std_msgs/Header", "vision_msgs/BoundingBox2D", "vision_msgs/Detection2D", "vision_msgs/ObjectHypothesis", "vision_msgs/ObjectHypothesisWithPose", "vision_msgs/Point2D", "vision_msgs/Pose2D"];
        ros1: own(ros1::vision_msgs::Detection2DArray) "vision_msgs/Detection2DArray", "f0664cf67ac73b03846b3620a3282d0e", "std_msgs/Header header\nvision_msgs/Detection2D[] detections\n", ["geometry_msgs/Point", "geometry_msgs/Pose", "geometry_msgs/Pose2D", "geometry_msgs/PoseWithCovariance", "geometry_msgs/Quaternion", "sensor_msgs/Image", "std_msgs/Header", "vision_msgs/BoundingBox2D", "vision_msgs/Detection2D", "vision_msgs/ObjectHypothesisWithPose"];
    }
    VisionMsgsDetection3D(vision_msgs::Detection3D) = "vision_msgs", "Detection3D" header {
        ros2: "RIHS01_ddd703be132ab0b69d33121f1bb034132bfbb3b0ac5f9fb1516005ba1c8a265b", "std_msgs/Header header\nvision_msgs/ObjectHypothesisWithPose[] results\nvision_msgs/BoundingBox3D bbox\nstring id\n", ["builtin_interfaces/Time", "geometry_msgs/Point", "geometry_msgs/Pose", "geometry_msgs/PoseWithCovariance", "geometry_msgs/Quaternion", "geometry_msgs/Vector3", "std_msgs/Header", "vision_msgs/BoundingBox3D", "vision_msgs/ObjectHypothesis", "vision_msgs/ObjectHypothesisWithPose"];
        ros1: own(ros1::vision_msgs::Detection3D) "vision_msgs/Detection3D", "1cc8d8ced6845e4044a3e33105cdf6a2", "std_msgs/Header header\nvision_msgs/ObjectHypothesisWithPose[] results\nvision_msgs/BoundingBox3D bbox\nsensor_msgs/PointCloud2 source_cloud\nbool is_tracking\nstring tracking_id\n", ["geometry_msgs/Point", "geometry_msgs/Pose", "geometry_msgs/PoseWithCovariance", "geometry_msgs/Quaternion", "geometry_msgs/Vector3", "sensor_msgs/PointCloud2", "sensor_msgs/PointField", "std_msgs/Header", "vision_msgs/BoundingBox3D", "vision_msgs/ObjectHypothesisWithPose"];
    }
    VisionMsgsDetection3DArray(vision_msgs::Detection3DArray) = "vision_msgs", "Detection3DArray" header {
        ros2: "RIHS01_793f5eab9595ac1c0da07873cc859db42eae51f0ee76056db8562515d830e018", "std_msgs/Header header\nvision_msgs/Detection3D[] detections\n", ["builtin_interfaces/Time", "geometry_msgs/Point", "geometry_msgs/Pose", "geometry_msgs/PoseWithCovariance", "geometry_msgs/Quaternion", "geometry_msgs/Vector3", "std_msgs/Header", "vision_msgs/BoundingBox3D", "vision_msgs/Detection3D", "vision_msgs/ObjectHypothesis", "vision_msgs/ObjectHypothesisWithPose"];
        ros1: own(ros1::vision_msgs::Detection3DArray) "vision_msgs/Detection3DArray", "3f9d50b3f55e5984eeeab956aafffe3b", "std_msgs/Header header\nvision_msgs/Detection3D[] detections\n", ["geometry_msgs/Point", "geometry_msgs/Pose", "geometry_msgs/PoseWithCovariance", "geometry_msgs/Quaternion", "geometry_msgs/Vector3", "sensor_msgs/PointCloud2", "sensor_msgs/PointField", "std_msgs/Header", "vision_msgs/BoundingBox3D", "vision_msgs/Detection3D", "vision_msgs/ObjectHypothesisWithPose"];
    }
    VisionMsgsLabelInfo(vision_msgs::LabelInfo) = "vision_msgs", "LabelInfo" header {
        ros2: "RIHS01_3d37df4015cdf660cc851c51897f2acd957e1ca6205ba0a99aebffb9406b0783", "std_msgs/Header header\nvision_msgs/VisionClass[] class_map\nfloat32 threshold\n", ["builtin_interfaces/Time", "std_msgs/Header", "vision_msgs/VisionClass"];
    }
    VisionMsgsObjectHypothesis(vision_msgs::ObjectHypothesis) = "vision_msgs", "ObjectHypothesis" {
        ros2: "RIHS01_51da43cec11c01957a64d1e05a24acd18aae7745ec30b74348ad5f6d634f7f90", "string class_id\nfloat64 score\n", [];
        ros1: own(ros1::vision_msgs::ObjectHypothesis) "vision_msgs/ObjectHypothesis", "abf73443e563396425a38201e9dacc73", "int64 id\nfloat64 score\n", [];
    }
    VisionMsgsObjectHypothesisWithPose(vision_msgs::ObjectHypothesisWithPose) = "vision_msgs", "ObjectHypothesisWithPose" {
        ros2: "RIHS01_41c12344c0396c48b81df12467c192d99b2a0eb1463c5c37194e4223251c80bc", "vision_msgs/ObjectHypothesis hypothesis\ngeometry_msgs/PoseWithCovariance pose\n", ["geometry_msgs/Point", "geometry_msgs/Pose", "geometry_msgs/PoseWithCovariance", "geometry_msgs/Quaternion", "vision_msgs/ObjectHypothesis"];
        ros1: own(ros1::vision_msgs::ObjectHypothesisWithPose) "vision_msgs/ObjectHypothesisWithPose", "fa1ab3bc7146f53921fa142d631d02db", "int64 id\nfloat64 score\ngeometry_msgs/PoseWithCovariance pose\n", ["geometry_msgs/Point", "geometry_msgs/Pose", "geometry_msgs/PoseWithCovariance", "geometry_msgs/Quaternion"];
    }
    VisionMsgsPoint2D(vision_msgs::Point2D) = "vision_msgs", "Point2D" {
        ros2: "RIHS01_eab0e83f44ab4de92ceaf76dd7d0e7638f2bdd1d16ffbe16c7a136c48e407247", "float64 x\nfloat64 y\n", [];
    }
    VisionMsgsPose2D(vision_msgs::Pose2D) = "vision_msgs", "Pose2D" {
        ros2: "RIHS01_b0b5d1d7b4c20dd4fcde3ed1d4b289a919290572007d67a97043814db25d3648", "vision_msgs/Point2D position\nfloat64 theta\n", ["vision_msgs/Point2D"];
    }
    VisionMsgsVisionClass(vision_msgs::VisionClass) = "vision_msgs", "VisionClass" {
        ros2: "RIHS01_1e4a11f0fed50b5623cb8ff26ca0e37952a48a9c074d16f804b44e9164c2037a", "uint16 class_id\nstring class_name\n", [];
    }
    VisionMsgsVisionInfo(vision_msgs::VisionInfo) = "vision_msgs", "VisionInfo" header {
        ros2: "RIHS01_95d3116a17484ad91c9a2686e1d54890bbfc3ff6c6a2de137738c4950d45d284", "std_msgs/Header header\nstring method\nstring database_location\nint32 database_version\n", ["builtin_interfaces/Time", "std_msgs/Header"];
        ros1: same() "vision_msgs/VisionInfo", "eee36f8dc558754ceb4ef619179d8b34", "std_msgs/Header header\nstring method\nstring database_location\nint32 database_version\n", ["std_msgs/Header"];
    }
    VisualizationMsgsImageMarker(visualization_msgs::ImageMarker) = "visualization_msgs", "ImageMarker" header {
        ros2: "RIHS01_603152491ef2331c200a5305230d31f6e8704875944b388da0f547c415d11836", "int32 CIRCLE=0\nint32 LINE_STRIP=1\nint32 LINE_LIST=2\nint32 POLYGON=3\nint32 POINTS=4\nint32 ADD=0\nint32 REMOVE=1\nstd_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\ngeometry_msgs/Point position\nfloat32 scale\nstd_msgs/ColorRGBA outline_color\nuint8 filled\nstd_msgs/ColorRGBA fill_color\nbuiltin_interfaces/Duration lifetime\ngeometry_msgs/Point[] points\nstd_msgs/ColorRGBA[] outline_colors\n", ["builtin_interfaces/Duration", "builtin_interfaces/Time", "geometry_msgs/Point", "std_msgs/ColorRGBA", "std_msgs/Header"];
        ros1: same() "visualization_msgs/ImageMarker", "1de93c67ec8858b831025a08fbf1b35c", "uint8 CIRCLE=0\nuint8 LINE_STRIP=1\nuint8 LINE_LIST=2\nuint8 POLYGON=3\nuint8 POINTS=4\nuint8 ADD=0\nuint8 REMOVE=1\nstd_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\ngeometry_msgs/Point position\nfloat32 scale\nstd_msgs/ColorRGBA outline_color\nuint8 filled\nstd_msgs/ColorRGBA fill_color\nduration lifetime\ngeometry_msgs/Point[] points\nstd_msgs/ColorRGBA[] outline_colors\n", ["geometry_msgs/Point", "std_msgs/ColorRGBA", "std_msgs/Header"];
    }
    VisualizationMsgsMarker(visualization_msgs::Marker) = "visualization_msgs", "Marker" header {
        ros2: "RIHS01_45b13ccf791f225962bf74e746f9644518855d783a6f42ba0cc14fde2b4f3ce0", "int32 ARROW=0\nint32 CUBE=1\nint32 SPHERE=2\nint32 CYLINDER=3\nint32 LINE_STRIP=4\nint32 LINE_LIST=5\nint32 CUBE_LIST=6\nint32 SPHERE_LIST=7\nint32 POINTS=8\nint32 TEXT_VIEW_FACING=9\nint32 MESH_RESOURCE=10\nint32 TRIANGLE_LIST=11\nint32 ARROW_STRIP=12\nint32 ADD=0\nint32 MODIFY=0\nint32 DELETE=2\nint32 DELETEALL=3\nstd_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\ngeometry_msgs/Pose pose\ngeometry_msgs/Vector3 scale\nstd_msgs/ColorRGBA color\nbuiltin_interfaces/Duration lifetime\nbool frame_locked\ngeometry_msgs/Point[] points\nstd_msgs/ColorRGBA[] colors\nstring texture_resource\nsensor_msgs/CompressedImage texture\nvisualization_msgs/UVCoordinate[] uv_coordinates\nstring text\nstring mesh_resource\nvisualization_msgs/MeshFile mesh_file\nbool mesh_use_embedded_materials\n", ["builtin_interfaces/Duration", "builtin_interfaces/Time", "geometry_msgs/Point", "geometry_msgs/Pose", "geometry_msgs/Quaternion", "geometry_msgs/Vector3", "sensor_msgs/CompressedImage", "std_msgs/ColorRGBA", "std_msgs/Header", "visualization_msgs/MeshFile", "visualization_msgs/UVCoordinate"];
        ros1: own(ros1::visualization_msgs::Marker) "visualization_msgs/Marker", "4048c9de2a16f4ae8e0538085ebf1b97", "uint8 ARROW=0\nuint8 CUBE=1\nuint8 SPHERE=2\nuint8 CYLINDER=3\nuint8 LINE_STRIP=4\nuint8 LINE_LIST=5\nuint8 CUBE_LIST=6\nuint8 SPHERE_LIST=7\nuint8 POINTS=8\nuint8 TEXT_VIEW_FACING=9\nuint8 MESH_RESOURCE=10\nuint8 TRIANGLE_LIST=11\nuint8 ADD=0\nuint8 MODIFY=0\nuint8 DELETE=2\nuint8 DELETEALL=3\nstd_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\ngeometry_msgs/Pose pose\ngeometry_msgs/Vector3 scale\nstd_msgs/ColorRGBA color\nduration lifetime\nbool frame_locked\ngeometry_msgs/Point[] points\nstd_msgs/ColorRGBA[] colors\nstring text\nstring mesh_resource\nbool mesh_use_embedded_materials\n", ["geometry_msgs/Point", "geometry_msgs/Pose", "geometry_msgs/Quaternion", "geometry_msgs/Vector3", "std_msgs/ColorRGBA", "std_msgs/Header"];
    }
    VisualizationMsgsMarkerArray(visualization_msgs::MarkerArray) = "visualization_msgs", "MarkerArray" {
        ros2: "RIHS01_86cb8800b6fb05b5eff1abd7a56f62a5641d3ae9a1c29e78e67e704f1d067dcf", "visualization_msgs/Marker[] markers\n", ["builtin_interfaces/Duration", "builtin_interfaces/Time", "geometry_msgs/Point", "geometry_msgs/Pose", "geometry_msgs/Quaternion", "geometry_msgs/Vector3", "sensor_msgs/CompressedImage", "std_msgs/ColorRGBA", "std_msgs/Header", "visualization_msgs/Marker", "visualization_msgs/MeshFile", "visualization_msgs/UVCoordinate"];
        ros1: own(ros1::visualization_msgs::MarkerArray) "visualization_msgs/MarkerArray", "d155b9ce5188fbaf89745847fd5882d7", "visualization_msgs/Marker[] markers\n", ["geometry_msgs/Point", "geometry_msgs/Pose", "geometry_msgs/Quaternion", "geometry_msgs/Vector3", "std_msgs/ColorRGBA", "std_msgs/Header", "visualization_msgs/Marker"];
    }
    VisualizationMsgsMeshFile(visualization_msgs::MeshFile) = "visualization_msgs", "MeshFile" {
        ros2: "RIHS01_7710ece15a148fb7c9b546364cfb215bb06098087bd6394fe5b73a493508f8c4", "string filename\nuint8[] data\n", [];
    }
    VisualizationMsgsUVCoordinate(visualization_msgs::UVCoordinate) = "visualization_msgs", "UVCoordinate" {
        ros2: "RIHS01_f27f7ed21fe360c6066944f856b801a0c0d1e94e815b6886444b42d90b196a26", "float32 u\nfloat32 v\n", [];
    }
}

services! {
    LifecycleMsgsChangeState(lifecycle_msgs::ChangeStateRequest, lifecycle_msgs::ChangeStateResponse) = "lifecycle_msgs", "ChangeState", "ffc3b243551f80931bfc3372959d41f2", "RIHS01_356fe34f0475a43acf54542013af4167b0e729f77ea22ffb045c6ad8e20668e5";
    LifecycleMsgsGetAvailableStates(lifecycle_msgs::GetAvailableStatesRequest, lifecycle_msgs::GetAvailableStatesResponse) = "lifecycle_msgs", "GetAvailableStates", "4f932bc31559332a55e79933c010fa18", "RIHS01_00a07d79d2207d71e81a8cbc1880e5d924cc16d4688ea8e8e06e443dc8f8aa1d";
    LifecycleMsgsGetAvailableTransitions(lifecycle_msgs::GetAvailableTransitionsRequest, lifecycle_msgs::GetAvailableTransitionsResponse) = "lifecycle_msgs", "GetAvailableTransitions", "a80c7b354bcdb5430ab0da0943807eb5", "RIHS01_59b7ecefce0982a8a844b9f2c4f14764c1c4543cc55e72924e2aa4adad83e9bc";
    LifecycleMsgsGetState(lifecycle_msgs::GetStateRequest, lifecycle_msgs::GetStateResponse) = "lifecycle_msgs", "GetState", "db428c05d10d50f6592ba030b8e4b051", "RIHS01_800a0a5aae599782b02932de0caf563f6dc4e7e94b794eadde075ba2cbef9795";
    RclInterfacesDescribeParameters(rcl_interfaces::DescribeParametersRequest, rcl_interfaces::DescribeParametersResponse) = "rcl_interfaces", "DescribeParameters", "3e8112cca714100a8ae5ed2f065093a8", "RIHS01_845b484d71eb0673dae682f2e3ba3c4851a65a3dcfb97bddd82c5b57e91e4cff";
    RclInterfacesGetParameterTypes(rcl_interfaces::GetParameterTypesRequest, rcl_interfaces::GetParameterTypesResponse) = "rcl_interfaces", "GetParameterTypes", "ee0005694d9e1e7c4757ee697be4dcc5", "RIHS01_da199c878688b3e530bdfe3ca8f74cb9fa0c303101e980a9e8f260e25e1c80ca";
    RclInterfacesGetParameters(rcl_interfaces::GetParametersRequest, rcl_interfaces::GetParametersResponse) = "rcl_interfaces", "GetParameters", "8ac544a03a02e4477b9721f3f7c2a9be", "RIHS01_bf9803d5c74cf989a5de3e0c2e99444599a627c7ff75f97b8c05b01003675cbc";
    RclInterfacesListParameters(rcl_interfaces::ListParametersRequest, rcl_interfaces::ListParametersResponse) = "rcl_interfaces", "ListParameters", "d064321287c33b91a0820c3036dc0b87", "RIHS01_3e6062bfbb27bfb8730d4cef2558221f51a11646d78e7bb30a1e83afac3aad9d";
    RclInterfacesSetParameters(rcl_interfaces::SetParametersRequest, rcl_interfaces::SetParametersResponse) = "rcl_interfaces", "SetParameters", "8f82da95ed562e7d91a7f87d70671d92", "RIHS01_56eed9a67e169f9cb6c1f987bc88f868c14a8fc9f743a263bc734c154015d7e0";
    RclInterfacesSetParametersAtomically(rcl_interfaces::SetParametersAtomicallyRequest, rcl_interfaces::SetParametersAtomicallyResponse) = "rcl_interfaces", "SetParametersAtomically", "b212f806e7a333d89be2051122e406bf", "RIHS01_0e192ef259c07fc3c07a13191d27002222e65e00ccec653ca05e856f79285fcd";
    StdSrvsEmpty(std_srvs::EmptyRequest, std_srvs::EmptyResponse) = "std_srvs", "Empty", "d41d8cd98f00b204e9800998ecf8427e", "RIHS01_5888399dedec5ccc85ea6451949fd2c9f97bfdf963f9a588821639fcd31b5d19";
    StdSrvsSetBool(std_srvs::SetBoolRequest, std_srvs::SetBoolResponse) = "std_srvs", "SetBool", "09fb03525b03e7ea1fd3992bafd87e16", "RIHS01_abe9e4bb6b41b40e6789712c00ec8871923e089af3f667a79992a428cff2da0a";
    StdSrvsTrigger(std_srvs::TriggerRequest, std_srvs::TriggerResponse) = "std_srvs", "Trigger", "937c9679a518e3a18d831e57125ea522", "RIHS01_eeff2cd6fa5ad9d27cdf4dec64818317839b62f212a91e6b5304b634b2062c5f";
}
