#ifndef OPENDR_H
#define OPENDR_H

/*
 * OpenDR in Rust: the C API. Generated from the library; docs/c.md explains it.
 *
 * Rules:
 *   - A function with the result opendr_status returns OPENDR_OK (0) or the kind of the error; opendr_last_error() returns its
 *     message.
 *   - A function writes a new handle to an opendr_X **, or NULL if the call fails. Free it with opendr_X_free(), which takes
 *     the address of the variable and sets it to NULL; freeing NULL does nothing.
 *   - Pointers that a function returns (texts, numbers, pixels) belong to the handle and are valid as long as the handle.
 *   - Arguments are copied, or only read during the call; the caller keeps them.
 *   - Texts are UTF-8. Paths are the bytes of the system's file names.
 *   - Learners, networks and sources can be used by several threads at once; values as long as no thread changes or frees them.
 *   - NULL, handles of another type and impossible lengths are errors. The caller guarantees that a pointer points to as much
 *     memory as its length states, and that a handle is not used after it was freed.
 */
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Handles of data and targets, one type each. */
typedef struct opendr_image opendr_image;
typedef struct opendr_image_with_detections opendr_image_with_detections;
typedef struct opendr_video opendr_video;
typedef struct opendr_point_cloud opendr_point_cloud;
typedef struct opendr_point_cloud_with_calibration opendr_point_cloud_with_calibration;
typedef struct opendr_calibration opendr_calibration;
typedef struct opendr_timeseries opendr_timeseries;
typedef struct opendr_vector opendr_vector;
typedef struct opendr_audio opendr_audio;
typedef struct opendr_skeleton_sequence opendr_skeleton_sequence;
typedef struct opendr_observation opendr_observation;
typedef struct opendr_bounding_box_list opendr_bounding_box_list;
typedef struct opendr_tracking_annotation_list opendr_tracking_annotation_list;
typedef struct opendr_bounding_box_3d_list opendr_bounding_box_3d_list;
typedef struct opendr_tracking_annotation_3d_list opendr_tracking_annotation_3d_list;
typedef struct opendr_pose_list opendr_pose_list;
typedef struct opendr_category opendr_category;
typedef struct opendr_heatmap opendr_heatmap;
typedef struct opendr_odometry opendr_odometry;
typedef struct opendr_text_region_list opendr_text_region_list;
typedef struct opendr_speech_command opendr_speech_command;
typedef struct opendr_base_transcription opendr_base_transcription;
typedef struct opendr_whisper_transcription opendr_whisper_transcription;
typedef struct opendr_vosk_transcription opendr_vosk_transcription;
typedef struct opendr_rl_target opendr_rl_target;

// The time stamp of a value without one.
#define OPENDR_NO_STAMP INT64_MIN

// The status of a call; the numbers are the exit codes of the command `opendr`.
typedef enum opendr_status {
    // The call succeeded.
    OPENDR_OK = 0,
    // A datum, target, pointer or file is invalid: null, wrong shape, empty, NaN, undecodable image.
    OPENDR_INVALID_INPUT = 11,
    // A parameter is unknown, of the wrong type or out of range.
    OPENDR_INVALID_PARAM = 12,
    // A file, model, learner, device node or class name does not exist.
    OPENDR_NOT_FOUND = 13,
    // The operating system refused to read or write.
    OPENDR_IO = 14,
    // A server or package client could not be reached, or the connection was lost.
    OPENDR_NETWORK = 15,
    // A file does not match its checksum or stated size, or an archive member has a path outside its folder.
    OPENDR_INTEGRITY = 16,
    // A file or message does not follow its format.
    OPENDR_FORMAT = 17,
    // The learner, runtime or build does not support the request.
    OPENDR_UNSUPPORTED = 18,
    // The requested device is not available or failed.
    OPENDR_DEVICE = 19,
    // A bug in OpenDR: please report it.
    OPENDR_INTERNAL = 20,
} opendr_status;

// The sample type of an image.
typedef enum opendr_sample_type {
    // 8 bits, 0 to 255.
    OPENDR_U8 = 0,
    // 16 bits: depth in millimetres, thermal counts.
    OPENDR_U16 = 1,
    // Floats: depth in metres, or colours.
    OPENDR_F32 = 2,
} opendr_sample_type;

// The channels of an image in memory.
typedef enum opendr_pixel_format {
    // One channel: brightness, depth.
    OPENDR_GREY = 0,
    // Red, green, blue.
    OPENDR_RGB = 1,
    // Blue, green, red (OpenCV).
    OPENDR_BGR = 2,
    // Red, green, blue, alpha.
    OPENDR_RGBA = 3,
    // Blue, green, red, alpha.
    OPENDR_BGRA = 4,
} opendr_pixel_format;

// The order of the axes of an image in memory.
typedef enum opendr_layout {
    // [height, width, channels]: interleaved channels (cameras, OpenCV).
    OPENDR_HWC = 0,
    // [channels, height, width]: planar channels (networks).
    OPENDR_CHW = 1,
} opendr_layout;

// The skeleton of a pose: its joints and their order (docs/json.md).
typedef enum opendr_skeleton {
    // OpenDR's 18 joints of a person.
    OPENDR_OPENDR18 = 0,
    // COCO's 17 joints of a person.
    OPENDR_COCO17 = 1,
    // BlazePose's 33 points of a person.
    OPENDR_BLAZEPOSE33 = 2,
    // MediaPipe's 21 joints of a left hand.
    OPENDR_LEFT_HAND21 = 3,
    // MediaPipe's 21 joints of a right hand.
    OPENDR_RIGHT_HAND21 = 4,
    // MediaPipe's 478 points of a face.
    OPENDR_FACE478 = 5,
    // JHMDB's 15 joints of a person.
    OPENDR_JHMDB15 = 6,
    // Kinect v2's 25 joints of a person, in the order of NTU RGB+D.
    OPENDR_NTU25 = 7,
    // The positions of the two jaws of a gripper for a grasp.
    OPENDR_GRASP2 = 8,
    // Up to 144 keypoints without names, by their index.
    OPENDR_POINTS = 9,
    // Kinect v1's 20 joints of a person, in the order of UTD-MHAD.
    OPENDR_KINECT20 = 10,
} opendr_skeleton;

// An environment; calls from several threads are serialised.
typedef struct opendr_env opendr_env;

// A learner with its model; calls from several threads are serialised.
typedef struct opendr_learner opendr_learner;

// A network; runs from several threads are serialised.
typedef struct opendr_network opendr_network;

// A sequence of images; calls from several threads are serialised.
typedef struct opendr_source opendr_source;

// A text created by the library; free it with opendr_string_free().
typedef struct opendr_string opendr_string;

// The outputs of one run of a network.
typedef struct opendr_tensors opendr_tensors;

// A datum or target of any type; a pointer to a handle of a data or target type can be cast to it.
typedef struct opendr_value opendr_value;

// The matrices of a calibration in row-major order, with KITTI's names.
typedef struct opendr_calibration_matrices {
    // Projection of the rectified camera frame into the left colour image.
    double p2[3][4];
    // Rectifying rotation.
    double r0_rect[3][3];
    // Transformation from the lidar frame to the camera frame, metres.
    double tr_velo_to_cam[3][4];
} opendr_calibration_matrices;

// Pixels in memory.
typedef struct opendr_pixels {
    // The first sample.
    const void *data;
    // Bytes from the first sample to the end of the memory.
    size_t size;
    // Width in pixels.
    size_t width;
    // Height in pixels.
    size_t height;
    // Bytes from one row to the next; 0 for contiguous rows. A plane has height rows.
    size_t row_stride;
    // One of opendr_sample_type.
    int32_t samples;
    // One of opendr_pixel_format.
    int32_t format;
    // One of opendr_layout.
    int32_t layout;
} opendr_pixels;

// A named part of an observation.
typedef struct opendr_observation_part {
    // Name of the part.
    const char *name;
    // Numbers in row-major order.
    const float *numbers;
    // Count of numbers.
    size_t length;
    // Length of each axis.
    const size_t *shape;
    // Number of axes.
    size_t axes;
} opendr_observation_part;

// The specification of an environment.
typedef struct opendr_env_spec {
    // Name and version; valid as long as the environment.
    const char *id;
    // Observation space in Gymnasium's notation; valid as long as the environment.
    const char *observation_space;
    // Action space in Gymnasium's notation; valid as long as the environment.
    const char *action_space;
    // Count of numbers of an observation.
    size_t observation_length;
    // Count of numbers of an action.
    size_t action_length;
    // Number of steps after which an episode is truncated; 0: unlimited.
    uint32_t max_episode_steps;
} opendr_env_spec;

// Reward of a step, and whether the episode is over.
typedef struct opendr_env_step_result {
    // The reward.
    double reward;
    // Whether a terminal state was reached.
    bool terminated;
    // Whether the episode was truncated by a time limit.
    bool truncated;
} opendr_env_step_result;

// Callback for the progress of a long call. context is the pointer given with the callback, what a description of the work,
// done and total the progress (total is 0 when unknown), status a text such as "loss 0.31, 42 images/s", or "". Returns
// whether to continue. It is called by one thread at a time, not always the same one, and must not use the running learner.
typedef bool (*opendr_progress)(void *context, const char *what, uint64_t done, uint64_t total, const char *status);

// A named input.
typedef struct opendr_input {
    // Name of the input, e.g. "image".
    const char *name;
    // A datum or target; NULL omits an optional input.
    const struct opendr_value *value;
} opendr_input;

// A named output.
typedef struct opendr_output {
    // Name of the output, e.g. "boxes".
    const char *name;
    // The prediction, set by the call, which must be freed; NULL if the call failed.
    struct opendr_value *value;
} opendr_output;

// A tensor in row-major order.
typedef struct opendr_tensor {
    // Name within the network; NULL for an input that is given by position.
    const char *name;
    // The numbers.
    const float *numbers;
    // Count of numbers: the product of the shape.
    size_t length;
    // Length of each axis.
    const size_t *shape;
    // Number of axes, at most 8.
    size_t axes;
} opendr_tensor;

// The declaration of an input or output of a network; valid as long as the network.
typedef struct opendr_tensor_info {
    // Name within the network.
    const char *name;
    // Length of each axis; 0 for a dynamic axis.
    const size_t *shape;
    // Number of axes; 0 for a single number, and where the network does not declare them.
    size_t axes;
} opendr_tensor_info;

// Pre-processing of an image: resizing, (sample - mean) / std per channel, and the layout of the result.
typedef struct opendr_preprocess {
    // Width of the input in pixels.
    size_t width;
    // Height of the input in pixels.
    size_t height;
    // The channels of the input: OPENDR_GREY, OPENDR_RGB or OPENDR_BGR.
    int32_t format;
    // One of opendr_layout.
    int32_t layout;
    // Mean of each channel, for samples of 0 to 255; greyscale uses the first.
    float mean[3];
    // Standard deviation of each channel, for samples of 0 to 255; not 0.
    float std[3];
    // Sample value of the padding (letterbox, with the image in the centre); NaN stretches the image instead.
    float pad;
} opendr_preprocess;

// A 3D box in the camera frame of KITTI: x right, y down, z forward.
typedef struct opendr_bounding_box_3d {
    // Class index; -1 when there is only a label.
    int64_t class_index;
    // Name of the class; NULL when unknown. In an item given to a list, it is used when class_index is -1.
    const char *label;
    // Fraction of the object outside the image, 0 to 1; -1 when unknown.
    float truncated;
    // 0 visible, 1 partly occluded, 2 largely occluded, 3 or -1 unknown.
    int32_t occluded;
    // Observation angle of the object, radians.
    float alpha;
    // The object in the image, corners x0, y0, x1, y1, pixels.
    float bbox2d[4];
    // Length, height and width, metres.
    float dimensions[3];
    // x, y, z of the centre of the bottom face, metres.
    float location[3];
    // Rotation about the vertical axis, radians; 0 faces along x.
    float rotation_y;
    // Score.
    float confidence;
} opendr_bounding_box_3d;

// A point in an image, pixels.
typedef struct opendr_point {
    // Pixels from the left edge.
    float x;
    // Pixels from the upper edge.
    float y;
} opendr_point;

// A box in an image. Masks (segments) are in the JSON of the list.
typedef struct opendr_bounding_box {
    // Class index; -1 when there is only a label.
    int64_t class_index;
    // Name of the class; NULL when unknown. In an item given to a list, it is used when class_index is -1.
    const char *label;
    // Left edge, pixels.
    float left;
    // Upper edge, pixels.
    float top;
    // Pixels to the right edge.
    float width;
    // Pixels to the lower edge.
    float height;
    // Score, 0 to 1.
    float confidence;
    // Points of the object (eyes, nose, corners of the mouth of a face).
    const struct opendr_point *landmarks;
    // Number of landmarks.
    size_t landmark_count;
} opendr_bounding_box;

// The fields of a category.
typedef struct opendr_category_fields {
    // Class index.
    int64_t class_index;
    // Name of the class; NULL when unknown.
    const char *description;
    // Score of the class, 0 to 1; NaN if there is none.
    float confidence;
    // Scores of all classes.
    const float *probabilities;
    // Number of probabilities; 0 if the learner predicts none.
    size_t probability_count;
} opendr_category_fields;

// The elements of a heatmap in row-major order: either labels or scores, the other is NULL.
typedef struct opendr_heatmap_fields {
    // Class indices.
    const uint32_t *labels;
    // Scores.
    const float *scores;
    // Number of elements.
    size_t length;
    // Length of each axis, e.g. height and width.
    const size_t *shape;
    // Number of axes, 1 to 8.
    size_t axes;
} opendr_heatmap_fields;

// The fields of an odometry.
typedef struct opendr_odometry_fields {
    // Whether the pose is known; position and orientation are NaN if it is not.
    bool is_known;
    // Position in the frame of the first image, metres: x to the right, y down, z ahead.
    double position[3];
    // Orientation as a quaternion x, y, z, w.
    double orientation[4];
    // Number of landmarks that agree with the pose.
    uint32_t num_landmarks;
} opendr_odometry_fields;

// A keypoint in an image, pixels; (-1, -1) means not detected.
typedef struct opendr_keypoint {
    // Pixels from the left edge.
    float x;
    // Pixels from the upper edge.
    float y;
    // Score, 0 to 1.
    float confidence;
} opendr_keypoint;

// The pose of one person or hand.
typedef struct opendr_pose {
    // The joints in the order of the skeleton.
    const struct opendr_keypoint *keypoints;
    // Number of keypoints.
    size_t keypoint_count;
    // Score of the pose, 0 to 1.
    float confidence;
    // One of opendr_skeleton.
    int32_t skeleton;
    // Id of the person's track; -1 if there is none.
    int64_t id;
} opendr_pose;

// The fields of a spoken command.
typedef struct opendr_speech_command_fields {
    // Class index; -1 if there is only a word.
    int64_t class_index;
    // The word; NULL when unknown. In fields given to a command, it is used when class_index is -1.
    const char *label;
    // Score, 0 to 1.
    float confidence;
    // Start within the audio, seconds; NaN when unknown.
    float begin_s;
    // End within the audio, seconds; NaN when unknown.
    float end_s;
} opendr_speech_command_fields;

// A line of text in an image.
typedef struct opendr_text_region {
    // The text.
    const char *text;
    // Corners, pixels: x and y of each, clockwise from the top left one of the text.
    float corners[8];
    // Score of the text, 0 to 1.
    float confidence;
} opendr_text_region;

// The 3D box of a tracked object at one time.
typedef struct opendr_tracking_annotation_3d {
    // The box.
    struct opendr_bounding_box_3d bounding_box_3d;
    // Identity of the object, the same at every time; -1 when unknown.
    int64_t id;
    // Index of the cloud in its recording; -1 if it has none.
    int64_t frame;
} opendr_tracking_annotation_3d;

// The box of a tracked object in one frame.
typedef struct opendr_tracking_annotation {
    // The box.
    struct opendr_bounding_box bounding_box;
    // Identity of the object, the same in every frame; -1 when unknown.
    int64_t id;
    // Index of the frame in its video; -1 if it has none.
    int64_t frame;
} opendr_tracking_annotation;

// A segment of a transcription. Tokens and scores are in the JSON of the transcription.
typedef struct opendr_whisper_segment {
    // Index of the segment.
    int64_t id;
    // Start within the audio, seconds.
    float start_s;
    // End within the audio, seconds.
    float end_s;
    // The text.
    const char *text;
} opendr_whisper_segment;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// Returns the text under a key of a JSON object, or of the object under section if that is not NULL; of a list, the item at
// index. Returns "" if there is none. Valid until the next call of this thread.
const char *opendr_json_text(const char *json,
                             const char *section,
                             const char *key,
                             int32_t index);

// Returns the number under a key, with the arguments of opendr_json_text(); 0 if there is none.
double opendr_json_number(const char *json, const char *section, const char *key, int32_t index);

// Creates a datum of the named type ("Vector", "PointCloud", ...) from length numbers in row-major order, which are copied.
enum opendr_status opendr_array_create(const char *type_name,
                                       const float *numbers,
                                       size_t length,
                                       const size_t *shape,
                                       size_t axes,
                                       struct opendr_value **value);

// Writes a pointer to the numbers of such a datum and the lengths of its axes; shape has room for axes lengths, the number
// of axes of the type. The numbers are valid as long as the datum.
enum opendr_status opendr_array_read(const struct opendr_value *value,
                                     const float **numbers,
                                     size_t *length,
                                     size_t *shape,
                                     size_t axes);

// Creates audio from length samples in [-1, 1], with interleaved channels, which are copied.
enum opendr_status opendr_audio_create(const float *samples,
                                       size_t length,
                                       size_t channels,
                                       uint32_t sample_rate,
                                       opendr_audio **audio);

// Writes a pointer to the samples of audio, valid as long as the audio, and their format.
enum opendr_status opendr_audio_read(const opendr_audio *audio,
                                     const float **samples,
                                     size_t *length,
                                     size_t *channels,
                                     uint32_t *sample_rate);

// Creates a calibration from its matrices.
enum opendr_status opendr_calibration_create(const struct opendr_calibration_matrices *matrices,
                                             opendr_calibration **calibration);

// Reads a calibration file of KITTI's detection or tracking benchmark.
enum opendr_status opendr_calibration_open(const char *path, opendr_calibration **calibration);

// Copies the matrices of a calibration.
enum opendr_status opendr_calibration_read(const opendr_calibration *calibration,
                                           struct opendr_calibration_matrices *matrices);

// Reads an image file: JPEG, PNG, BMP or WebP.
enum opendr_status opendr_image_open(const char *path, opendr_image **image);

// Decodes an image from the bytes of a file.
enum opendr_status opendr_image_decode(const uint8_t *bytes, size_t size, opendr_image **image);

// Creates an image from pixels in memory, which are copied.
enum opendr_status opendr_image_create(const struct opendr_pixels *pixels, opendr_image **image);

// Writes a pointer to the pixels of an image and their format. They are valid as long as the image, and until it is drawn
// on.
enum opendr_status opendr_image_read(const opendr_image *image,
                                     struct opendr_pixels *pixels);

// Writes an image file in the format of its extension: .jpg, .png, .bmp or .webp.
enum opendr_status opendr_image_save(const opendr_image *image, const char *path);

// Creates an image with boxes; the caller keeps image and boxes.
enum opendr_status opendr_image_with_detections_create(const opendr_image *image,
                                                       const opendr_bounding_box_list *boxes,
                                                       opendr_image_with_detections **both);

// Creates new handles of the image and of the boxes, which must be freed.
enum opendr_status opendr_image_with_detections_read(const opendr_image_with_detections *both,
                                                     opendr_image **image,
                                                     opendr_bounding_box_list **boxes);

// Creates an observation without parts from length numbers, which are copied.
enum opendr_status opendr_observation_create(const float *numbers, size_t length, opendr_observation **observation);

// Creates an observation from named parts, which are copied.
enum opendr_status opendr_observation_create_parts(const struct opendr_observation_part *parts,
                                                   size_t count,
                                                   opendr_observation **observation);

// Writes a pointer to all numbers of an observation as a flat array, valid as long as the observation.
enum opendr_status opendr_observation_read(const opendr_observation *observation,
                                           const float **numbers,
                                           size_t *length);

// Returns the number of named parts of an observation; 0 if the handle is not an observation.
size_t opendr_observation_part_count(const opendr_observation *observation);

// Writes a part of an observation into part; its pointers are valid as long as the observation.
enum opendr_status opendr_observation_get(const opendr_observation *observation,
                                          size_t index,
                                          struct opendr_observation_part *part);

// Creates a point cloud with its calibration; the caller keeps both. image_shape is the height and width of the camera's
// image in pixels, or NULL.
enum opendr_status opendr_point_cloud_with_calibration_create(const opendr_point_cloud *cloud,
                                                              const opendr_calibration *calibration,
                                                              const size_t *image_shape,
                                                              opendr_point_cloud_with_calibration **both);

// Creates new handles of the point cloud and of the calibration, which must be freed; height and width of the image are 0
// when unknown.
enum opendr_status opendr_point_cloud_with_calibration_read(const opendr_point_cloud_with_calibration *both,
                                                            opendr_point_cloud **cloud,
                                                            opendr_calibration **calibration,
                                                            size_t *height,
                                                            size_t *width);

// Draws a target on an image; types that cannot be drawn leave it unchanged. Copies of the image are not changed.
enum opendr_status opendr_value_draw(const struct opendr_value *target, opendr_image *image);

// Creates an environment, e.g. "CartPole-v1".
//
// params_json is an object of its parameters; NULL uses the defaults.
enum opendr_status opendr_env_make(const char *id, const char *params_json, struct opendr_env **env);

// Writes the specification of an environment into spec.
enum opendr_status opendr_env_describe(const struct opendr_env *env, struct opendr_env_spec *spec);

// Begins an episode; observation, which may be NULL, receives the observation, which must be freed.
//
// A seed determines all random numbers until the next seed; NULL continues the current stream of random numbers.
enum opendr_status opendr_env_reset(struct opendr_env *env, const uint64_t *seed, opendr_observation **observation);

// Takes a step with an action of count numbers; observation, which may be NULL, receives the observation, which must be
// freed.
enum opendr_status opendr_env_step(struct opendr_env *env,
                                   const float *action,
                                   size_t count,
                                   struct opendr_env_step_result *result,
                                   opendr_observation **observation);

// Writes a number of the info of the last reset or step, e.g. "success", into value.
enum opendr_status opendr_env_info(const struct opendr_env *env, const char *name, double *value);

// Frees an environment and sets the variable to NULL.
enum opendr_status opendr_env_close(struct opendr_env **env);

// Evaluates the learner on a data set on disk.
//
// dataset_type is its format, e.g. "coco"; NULL detects it. options_json is an object: "metric", "metric_params",
// "split", "limit", "out", "skip_broken", "classes" (an object: classes of the data set by classes of the learner), "by_number",
// "resamples", and "then", a list of pretrained learners after this one, such as ["byte_track"], to evaluate the pipeline;
// NULL uses the defaults. The outcome is a JSON object, with the scalars by name under "scalars"; it must be freed.
enum opendr_status opendr_eval(const struct opendr_learner *learner,
                               const char *dataset,
                               const char *dataset_type,
                               const char *options_json,
                               struct opendr_string **outcome);

// Trains the learner on a data set on disk, from its model if it has one, and loads the result.
//
// dataset_type is its format, e.g. "coco"; NULL detects it. options_json is an object: "params" (of the training), "split",
// "val", "val_format", "val_split", "limit", "out", "logging_path", "resume", "teacher", "teacher_threshold",
// "teacher_classes", "keep_empty", "skip_broken"; NULL uses the defaults. progress, which may be NULL, receives the progress
// and may stop the training, which then saves a checkpoint to resume from. The report is a JSON object, with the values by
// name under "curves" and "scalars" and the path of the trained container under "model"; it must be freed.
enum opendr_status opendr_fit(const struct opendr_learner *learner,
                              const char *dataset,
                              const char *dataset_type,
                              const char *options_json,
                              opendr_progress progress,
                              void *context,
                              struct opendr_string **report);

// Trains a policy in the environment id, e.g. "CartPole-v1", from its model if it has one, and loads the result.
//
// env_params_json is an object of parameters of the environment; NULL uses the defaults. options_json is an object:
// "params" (of the training), "out", "logging_path", "resume"; NULL uses the defaults. progress and report are the same as
// for opendr_fit.
enum opendr_status opendr_fit_policy(const struct opendr_learner *learner,
                                     const char *id,
                                     const char *env_params_json,
                                     const char *options_json,
                                     opendr_progress progress,
                                     void *context,
                                     struct opendr_string **report);

// Loads a learner, e.g. "nanodet" or "yunet/320".
//
// path is a model container of your own; NULL loads the pretrained model, which is downloaded the first time. device is
// "cpu", "cuda:0", ...; NULL selects the best available. params_json is an object of parameters; NULL uses the defaults.
enum opendr_status opendr_load(const char *name,
                               const char *path,
                               const char *device,
                               const char *params_json,
                               struct opendr_learner **learner);

// Creates a learner without a model, e.g. "ssd", for training with opendr_fit. device and params_json are the same as for
// opendr_load.
enum opendr_status opendr_create(const char *name,
                                 const char *device,
                                 const char *params_json,
                                 struct opendr_learner **learner);

// Predicts the outputs for named inputs on the learner's own stream. Each requested output receives a new handle, which must
// be freed; not all outputs have to be requested. The caller keeps the inputs.
enum opendr_status opendr_infer(const struct opendr_learner *learner,
                                const struct opendr_input *inputs,
                                size_t input_count,
                                struct opendr_output *outputs,
                                size_t output_count);

// Returns the name of the learner's input index, or NULL after the last; valid as long as the learner.
const char *opendr_input_name(const struct opendr_learner *learner, size_t index);

// Returns the type of the learner's input index, e.g. "Image", or NULL after the last; valid as long as the learner.
const char *opendr_input_type(const struct opendr_learner *learner, size_t index);

// Returns the name of the learner's output index, or NULL after the last; valid as long as the learner.
const char *opendr_output_name(const struct opendr_learner *learner, size_t index);

// Sets a live parameter; value_json is a number, text, boolean, list or null.
enum opendr_status opendr_set_param(const struct opendr_learner *learner, const char *name, const char *value_json);

// Writes the current parameters as a JSON object, which must be freed.
enum opendr_status opendr_params(const struct opendr_learner *learner, struct opendr_string **json);

// Resets the state of the learner's own stream.
enum opendr_status opendr_reset(const struct opendr_learner *learner);

// Writes the names of the classes in order as a JSON list, which must be freed; empty when classes have no names.
enum opendr_status opendr_classes(const struct opendr_learner *learner, struct opendr_string **json);

// Writes the number of classes with names into count.
enum opendr_status opendr_class_count(const struct opendr_learner *learner, size_t *count);

// Returns the name of a class, or NULL if it has none; valid as long as the learner.
const char *opendr_class_name(const struct opendr_learner *learner, int64_t class_index);

// Writes the model with the current parameters as a container to the folder path.
enum opendr_status opendr_save(const struct opendr_learner *learner, const char *path);

// Frees the learner and sets the variable to NULL; does nothing if it is NULL.
enum opendr_status opendr_learner_free(struct opendr_learner **learner);

// Writes the names of all learners as a JSON list, which must be freed.
enum opendr_status opendr_learners(struct opendr_string **json);

// Opens a network without its learner. path is an ONNX file (*.onnx) or a model container: a folder, its JSON (OpenDR's
// too) or a zip.
//
// file is the ONNX file within a container, e.g. "encoder.onnx" or "detector/model.onnx"; NULL selects the only one. device
// is "cpu", "cuda:0", ...; NULL selects the best available. Returns OPENDR_UNSUPPORTED for a network with inputs of other
// types than float.
enum opendr_status opendr_network_open(const char *path,
                                       const char *file,
                                       const char *device,
                                       struct opendr_network **network);

// Opens the network of a loaded learner again, on the learner's device, to run it without the learner's pre- and
// post-processing. file is the same as for opendr_network_open(); the learner may be freed.
enum opendr_status opendr_learner_network(const struct opendr_learner *learner,
                                          const char *file,
                                          struct opendr_network **network);

// Runs a network. Each input is given once, by its name or, where that is NULL, by its position. tensors receives the outputs
// in the network's order, which must be freed.
enum opendr_status opendr_network_run(const struct opendr_network *network,
                                      const struct opendr_tensor *inputs,
                                      size_t input_count,
                                      struct opendr_tensors **tensors);

// Returns the number of the network's inputs.
size_t opendr_network_input_count(const struct opendr_network *network);

// Returns the number of the network's outputs.
size_t opendr_network_output_count(const struct opendr_network *network);

// Writes the declaration of the network's input index into info.
enum opendr_status opendr_network_input(const struct opendr_network *network,
                                        size_t index,
                                        struct opendr_tensor_info *info);

// Writes the declaration of the network's output index into info.
enum opendr_status opendr_network_output(const struct opendr_network *network,
                                         size_t index,
                                         struct opendr_tensor_info *info);

// Writes the model.json of the network's container as JSON ("learner", "params", "classes", "inputs", ...), which must be
// freed; "{}" for an ONNX file.
enum opendr_status opendr_network_manifest(const struct opendr_network *network,
                                           struct opendr_string **json);

// Frees the network and sets the variable to NULL; does nothing if it is NULL.
enum opendr_status opendr_network_free(struct opendr_network **network);

// Writes the network input for an image into numbers: length numbers, width * height * channels.
enum opendr_status opendr_image_preprocess(const opendr_image *image,
                                           const struct opendr_preprocess *how,
                                           float *numbers,
                                           size_t length);

// Opens an image, a folder, a pattern ("photos/\*.jpg"), a video, or a camera ("camera:0").
enum opendr_status opendr_source_open(const char *input, struct opendr_source **source);

// Reads the next image, which must be freed; *image is NULL at the end. After a file that cannot be read, the next call
// continues with the next file.
enum opendr_status opendr_source_next(struct opendr_source *source, opendr_image **image);

// Returns the file of the last image or the last failure; "" for a camera, and before the first image. Valid until the next
// call with this source.
const char *opendr_source_path(const struct opendr_source *source);

// Closes the source and sets the variable to NULL; does nothing if it is NULL.
enum opendr_status opendr_source_free(struct opendr_source **source);

// Returns the message of the last failed call of this thread; "" if none failed. Valid until the next failing call of this
// thread.
const char *opendr_last_error(void);

// Sets the message that opendr_last_error() returns in this thread, for functions implemented with those of this header.
void opendr_set_last_error(const char *message);

// Returns the name of a status, e.g. "InvalidInput"; "unknown" for other numbers.
const char *opendr_status_name(int32_t status);

// Returns the version of the library, e.g. "0.1.0".
const char *opendr_version(void);

// Returns the text in UTF-8, terminated by a zero byte, or NULL if the handle is not a string; valid as long as the string.
const char *opendr_string_text(const struct opendr_string *string);

// Returns the length of the text in bytes, without the terminating zero byte.
size_t opendr_string_length(const struct opendr_string *string);

// Frees the string and sets the variable to NULL; does nothing if it is NULL.
enum opendr_status opendr_string_free(struct opendr_string **string);

// Creates a list of items, which are copied.
enum opendr_status opendr_bounding_box_3d_list_create(const struct opendr_bounding_box_3d *items,
                                                      size_t count,
                                                      opendr_bounding_box_3d_list **list);

// Returns the number of boxes; 0 if the handle is not such a list.
size_t opendr_bounding_box_3d_list_count(const opendr_bounding_box_3d_list *list);

// Writes an item of the list into item; its pointers are valid as long as the list.
enum opendr_status opendr_bounding_box_3d_list_get(const opendr_bounding_box_3d_list *list,
                                                   size_t index,
                                                   struct opendr_bounding_box_3d *item);

// Creates a list of items, which are copied.
enum opendr_status opendr_bounding_box_list_create(const struct opendr_bounding_box *items,
                                                   size_t count,
                                                   opendr_bounding_box_list **list);

// Returns the number of boxes; 0 if the handle is not such a list.
size_t opendr_bounding_box_list_count(const opendr_bounding_box_list *list);

// Writes an item of the list into item; its pointers are valid as long as the list.
enum opendr_status opendr_bounding_box_list_get(const opendr_bounding_box_list *list,
                                                size_t index,
                                                struct opendr_bounding_box *item);

// Creates a category; the fields are copied.
enum opendr_status opendr_category_create(const struct opendr_category_fields *fields, opendr_category **category);

// Writes the fields of a category; their pointers are valid as long as the category.
enum opendr_status opendr_category_read(const opendr_category *category, struct opendr_category_fields *fields);

// Creates a heatmap; the elements are copied.
enum opendr_status opendr_heatmap_create(const struct opendr_heatmap_fields *fields, opendr_heatmap **heatmap);

// Writes pointers to the elements of a heatmap, valid as long as the heatmap.
enum opendr_status opendr_heatmap_read(const opendr_heatmap *heatmap, struct opendr_heatmap_fields *fields);

// Creates an odometry; the fields are copied.
enum opendr_status opendr_odometry_create(const struct opendr_odometry_fields *fields, opendr_odometry **odometry);

// Writes the fields of an odometry.
enum opendr_status opendr_odometry_read(const opendr_odometry *odometry, struct opendr_odometry_fields *fields);

// Creates a list of items, which are copied.
enum opendr_status opendr_pose_list_create(const struct opendr_pose *items, size_t count, opendr_pose_list **list);

// Returns the number of persons; 0 if the handle is not such a list.
size_t opendr_pose_list_count(const opendr_pose_list *list);

// Writes an item of the list into item; its pointers are valid as long as the list.
enum opendr_status opendr_pose_list_get(const opendr_pose_list *list, size_t index, struct opendr_pose *item);

// Creates an action from count numbers, which are copied.
enum opendr_status opendr_rl_target_create(const float *values, size_t count, opendr_rl_target **target);

// Writes a pointer to the numbers of an action as a flat array in the order of the action space, valid as long as the action.
enum opendr_status opendr_rl_target_read(const opendr_rl_target *target,
                                         const float **values,
                                         size_t *count);

// Creates a command; the fields are copied.
enum opendr_status opendr_speech_command_create(const struct opendr_speech_command_fields *fields,
                                                opendr_speech_command **command);

// Writes the fields of a command; the word is valid as long as the command.
enum opendr_status opendr_speech_command_read(const opendr_speech_command *command,
                                              struct opendr_speech_command_fields *fields);

// Creates a list of items, which are copied.
enum opendr_status opendr_text_region_list_create(const struct opendr_text_region *items,
                                                  size_t count,
                                                  opendr_text_region_list **list);

// Returns the number of regions; 0 if the handle is not such a list.
size_t opendr_text_region_list_count(const opendr_text_region_list *list);

// Writes an item of the list into item; its text is valid as long as the list.
enum opendr_status opendr_text_region_list_get(const opendr_text_region_list *list,
                                               size_t index,
                                               struct opendr_text_region *item);

// Creates a list of items, which are copied.
enum opendr_status opendr_tracking_annotation_3d_list_create(const struct opendr_tracking_annotation_3d *items,
                                                             size_t count,
                                                             opendr_tracking_annotation_3d_list **list);

// Returns the number of tracks; 0 if the handle is not such a list.
size_t opendr_tracking_annotation_3d_list_count(const opendr_tracking_annotation_3d_list *list);

// Writes an item of the list into item; its pointers are valid as long as the list.
enum opendr_status opendr_tracking_annotation_3d_list_get(const opendr_tracking_annotation_3d_list *list,
                                                          size_t index,
                                                          struct opendr_tracking_annotation_3d *item);

// Creates a list of items, which are copied.
enum opendr_status opendr_tracking_annotation_list_create(const struct opendr_tracking_annotation *items,
                                                          size_t count,
                                                          opendr_tracking_annotation_list **list);

// Returns the number of tracks; 0 if the handle is not such a list.
size_t opendr_tracking_annotation_list_count(const opendr_tracking_annotation_list *list);

// Writes an item of the list into item; its pointers are valid as long as the list.
enum opendr_status opendr_tracking_annotation_list_get(const opendr_tracking_annotation_list *list,
                                                       size_t index,
                                                       struct opendr_tracking_annotation *item);

// Creates a transcription from its text.
enum opendr_status opendr_base_transcription_create(const char *text, opendr_base_transcription **transcription);

// Returns the text, or NULL if the handle is not such a transcription; valid as long as the transcription.
const char *opendr_base_transcription_text(const opendr_base_transcription *transcription);

// Creates an intermediate or final transcription of a streaming recogniser; finished is whether the phrase is final.
enum opendr_status opendr_vosk_transcription_create(const char *text,
                                                    bool finished,
                                                    opendr_vosk_transcription **transcription);

// Returns the text so far, or NULL if the handle is not such a transcription; valid as long as the transcription.
const char *opendr_vosk_transcription_text(const opendr_vosk_transcription *transcription);

// Returns whether the phrase is final: its text will not change any more.
bool opendr_vosk_transcription_finished(const opendr_vosk_transcription *transcription);

// Creates a transcription from its text and segments, which are copied.
enum opendr_status opendr_whisper_transcription_create(const char *text,
                                                       const struct opendr_whisper_segment *segments,
                                                       size_t count,
                                                       opendr_whisper_transcription **transcription);

// Returns the text, or NULL if the handle is not such a transcription; valid as long as the transcription.
const char *opendr_whisper_transcription_text(const opendr_whisper_transcription *transcription);

// Returns the number of segments; 0 if the handle is not such a transcription.
size_t opendr_whisper_transcription_count(const opendr_whisper_transcription *transcription);

// Writes a segment into segment; its text is valid as long as the transcription.
enum opendr_status opendr_whisper_transcription_get(const opendr_whisper_transcription *transcription,
                                                    size_t index,
                                                    struct opendr_whisper_segment *segment);

// Returns the number of tensors.
size_t opendr_tensors_count(const struct opendr_tensors *tensors);

// Writes tensor index into tensor; its pointers are valid as long as the tensors. Integers and booleans of a network are
// converted to floats, with rounding.
enum opendr_status opendr_tensors_get(const struct opendr_tensors *tensors,
                                      size_t index,
                                      struct opendr_tensor *tensor);

// Frees the tensors and sets the variable to NULL; does nothing if it is NULL.
enum opendr_status opendr_tensors_free(struct opendr_tensors **tensors);

// Returns the name of the value's type, e.g. "BoundingBoxList", or NULL if the handle is not a value; valid as long as the
// value.
const char *opendr_value_type(const struct opendr_value *value);

// Writes the JSON of a target (docs/json.md), which must be freed.
enum opendr_status opendr_value_to_json(const struct opendr_value *value, struct opendr_string **json);

// Reads a target from its JSON (docs/json.md). type_name is the expected type, or NULL for any.
enum opendr_status opendr_value_from_json(const char *type_name, const char *json, struct opendr_value **value);

// Reads a file as a value of the named type: "Image" (JPEG, PNG, BMP, WebP), "Audio" (WAVE), "Timeseries" (a table of
// numbers as CSV or text, one line per time step; or NPY), "PointCloud" (KITTI's scans), or the JSON of a target.
enum opendr_status opendr_value_open(const char *type_name, const char *path, struct opendr_value **value);

// Writes the text of the value for people, one line per item, which must be freed.
enum opendr_status opendr_value_to_text(const struct opendr_value *value, struct opendr_string **string);

// Writes the time stamp of the value in nanoseconds; OPENDR_NO_STAMP when unknown.
enum opendr_status opendr_value_stamp(const struct opendr_value *value, int64_t *stamp_ns);

// Sets the time stamp of the value; OPENDR_NO_STAMP removes it.
enum opendr_status opendr_value_set_stamp(struct opendr_value *value, int64_t stamp_ns);

// Returns the coordinate frame of the value, or NULL when unknown; valid as long as the value.
const char *opendr_value_frame_id(const struct opendr_value *value);

// Sets the coordinate frame of the value; NULL removes it.
enum opendr_status opendr_value_set_frame_id(struct opendr_value *value, const char *frame_id);

// Creates another handle of the same value; large payloads are shared.
enum opendr_status opendr_value_copy(const struct opendr_value *value, struct opendr_value **copy);

// Frees the value and sets the variable to NULL; does nothing if it is NULL.
enum opendr_status opendr_value_free(struct opendr_value **value);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

/* Names from before 0.1, deprecated; they compile until 1.0. */
#define opendr_fit_in opendr_fit_policy
#define opendr_network_of opendr_learner_network
#define opendr_samples opendr_sample_type

/*
 * Functions of each data and target type X: opendr_X_free(), opendr_X_copy(), opendr_X_to_text(), opendr_X_stamp(),
 * opendr_X_set_stamp(), opendr_X_frame_id(), opendr_X_set_frame_id(); see the functions opendr_value_free(), ... .
 */
#define OPENDR_VALUE_FUNCTIONS(X) \
    static inline opendr_status X##_free(X **variable) { \
        opendr_value *value = variable == NULL ? NULL : (opendr_value *)*variable; \
        opendr_status status = opendr_value_free(variable == NULL ? NULL : &value); \
        if (variable != NULL) *variable = (X *)value; \
        return status; \
    } \
    static inline opendr_status X##_copy(const X *value, X **variable) { \
        opendr_value *copy = NULL; \
        opendr_status status = opendr_value_copy((const opendr_value *)value, variable == NULL ? NULL : &copy); \
        if (variable != NULL) *variable = (X *)copy; \
        return status; \
    } \
    static inline opendr_status X##_to_text(const X *value, opendr_string **text) { \
        return opendr_value_to_text((const opendr_value *)value, text); \
    } \
    static inline opendr_status X##_stamp(const X *value, int64_t *stamp_ns) { \
        return opendr_value_stamp((const opendr_value *)value, stamp_ns); \
    } \
    static inline opendr_status X##_set_stamp(X *value, int64_t stamp_ns) { \
        return opendr_value_set_stamp((opendr_value *)value, stamp_ns); \
    } \
    static inline const char *X##_frame_id(const X *value) { \
        return opendr_value_frame_id((const opendr_value *)value); \
    } \
    static inline opendr_status X##_set_frame_id(X *value, const char *frame_id) { \
        return opendr_value_set_frame_id((opendr_value *)value, frame_id); \
    }

/* Further functions of each target type X: opendr_X_to_json(), opendr_X_from_json() and opendr_X_draw(). */
#define OPENDR_TARGET_FUNCTIONS(X, name) \
    static inline opendr_status X##_to_json(const X *value, opendr_string **json) { \
        return opendr_value_to_json((const opendr_value *)value, json); \
    } \
    static inline opendr_status X##_from_json(const char *json, X **variable) { \
        opendr_value *value = NULL; \
        opendr_status status = opendr_value_from_json(name, json, variable == NULL ? NULL : &value); \
        if (variable != NULL) *variable = (X *)value; \
        return status; \
    } \
    static inline opendr_status X##_draw(const X *value, opendr_image *image) { \
        return opendr_value_draw((const opendr_value *)value, image); \
    }

/* Further functions of each array type X: opendr_X_create() and opendr_X_read(); see opendr_array_create(). */
#define OPENDR_ARRAY_FUNCTIONS(X, name, axes) \
    static inline opendr_status X##_create(const float *numbers, size_t length, const size_t shape[axes], X **variable) { \
        opendr_value *value = NULL; \
        opendr_value **place = variable == NULL ? NULL : &value; \
        opendr_status status = opendr_array_create(name, numbers, length, shape, axes, place); \
        if (variable != NULL) *variable = (X *)value; \
        return status; \
    } \
    static inline opendr_status X##_read(const X *value, const float **numbers, size_t *length, size_t shape[axes]) { \
        return opendr_array_read((const opendr_value *)value, numbers, length, shape, axes); \
    }

OPENDR_VALUE_FUNCTIONS(opendr_image)
OPENDR_VALUE_FUNCTIONS(opendr_image_with_detections)
OPENDR_VALUE_FUNCTIONS(opendr_video)
OPENDR_VALUE_FUNCTIONS(opendr_point_cloud)
OPENDR_VALUE_FUNCTIONS(opendr_point_cloud_with_calibration)
OPENDR_VALUE_FUNCTIONS(opendr_calibration)
OPENDR_VALUE_FUNCTIONS(opendr_timeseries)
OPENDR_VALUE_FUNCTIONS(opendr_vector)
OPENDR_VALUE_FUNCTIONS(opendr_audio)
OPENDR_VALUE_FUNCTIONS(opendr_skeleton_sequence)
OPENDR_VALUE_FUNCTIONS(opendr_observation)
OPENDR_VALUE_FUNCTIONS(opendr_bounding_box_list)
OPENDR_VALUE_FUNCTIONS(opendr_tracking_annotation_list)
OPENDR_VALUE_FUNCTIONS(opendr_bounding_box_3d_list)
OPENDR_VALUE_FUNCTIONS(opendr_tracking_annotation_3d_list)
OPENDR_VALUE_FUNCTIONS(opendr_pose_list)
OPENDR_VALUE_FUNCTIONS(opendr_category)
OPENDR_VALUE_FUNCTIONS(opendr_heatmap)
OPENDR_VALUE_FUNCTIONS(opendr_odometry)
OPENDR_VALUE_FUNCTIONS(opendr_text_region_list)
OPENDR_VALUE_FUNCTIONS(opendr_speech_command)
OPENDR_VALUE_FUNCTIONS(opendr_base_transcription)
OPENDR_VALUE_FUNCTIONS(opendr_whisper_transcription)
OPENDR_VALUE_FUNCTIONS(opendr_vosk_transcription)
OPENDR_VALUE_FUNCTIONS(opendr_rl_target)

OPENDR_TARGET_FUNCTIONS(opendr_bounding_box_list, "BoundingBoxList")
OPENDR_TARGET_FUNCTIONS(opendr_tracking_annotation_list, "TrackingAnnotationList")
OPENDR_TARGET_FUNCTIONS(opendr_bounding_box_3d_list, "BoundingBox3DList")
OPENDR_TARGET_FUNCTIONS(opendr_tracking_annotation_3d_list, "TrackingAnnotation3DList")
OPENDR_TARGET_FUNCTIONS(opendr_pose_list, "PoseList")
OPENDR_TARGET_FUNCTIONS(opendr_category, "Category")
OPENDR_TARGET_FUNCTIONS(opendr_heatmap, "Heatmap")
OPENDR_TARGET_FUNCTIONS(opendr_odometry, "Odometry")
OPENDR_TARGET_FUNCTIONS(opendr_text_region_list, "TextRegionList")
OPENDR_TARGET_FUNCTIONS(opendr_speech_command, "SpeechCommand")
OPENDR_TARGET_FUNCTIONS(opendr_base_transcription, "BaseTranscription")
OPENDR_TARGET_FUNCTIONS(opendr_whisper_transcription, "WhisperTranscription")
OPENDR_TARGET_FUNCTIONS(opendr_vosk_transcription, "VoskTranscription")
OPENDR_TARGET_FUNCTIONS(opendr_rl_target, "RlTarget")

/* shape: channels, time, height, width */
OPENDR_ARRAY_FUNCTIONS(opendr_video, "Video", 4)
/* shape: points, channels */
OPENDR_ARRAY_FUNCTIONS(opendr_point_cloud, "PointCloud", 2)
/* shape: time, features */
OPENDR_ARRAY_FUNCTIONS(opendr_timeseries, "Timeseries", 2)
/* shape: features */
OPENDR_ARRAY_FUNCTIONS(opendr_vector, "Vector", 1)
/* shape: samples, channels, frames, joints, persons */
OPENDR_ARRAY_FUNCTIONS(opendr_skeleton_sequence, "SkeletonSequence", 5)

/*
 * Learners. opendr_load_X() is opendr_load() with the learner's name; opendr_infer_X() is opendr_infer() with its inputs
 * and outputs. An output that is not needed may be NULL.
 */

/*
 * CenterNetDetectorLearner: CenterNet on MobileNetV3 detects the 80 COCO classes; the most precise of the light detectors.
 *
 * Parameters:
 *   threshold (a float 0..=1, live, default 0.3): Score below which detections are dropped.
 *   iou_threshold (a float 0..=1, live, default 0.5): IoU above which boxes of one class count as one object.
 *   max_detections (an int 1..=100, live, default 100): Maximum number of boxes per image.
 *   suppression (a str, one of hard, soft, fast, cluster, live, default hard): Method of non-maximum suppression.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   boxes (BoundingBoxList)
 */
static inline opendr_status opendr_load_centernet(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("centernet", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_centernet(const opendr_learner *learner,
    const opendr_image *image,
    opendr_bounding_box_list **boxes) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "boxes";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (boxes != NULL) *boxes = (opendr_bounding_box_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * NanodetLearner: NanoDet detects the 80 COCO classes; light, good for small objects.
 *
 * Parameters:
 *   threshold (a float 0..=1, live, default 0.35): Score below which detections are dropped.
 *   iou_threshold (a float 0..=1, live, default 0.6): IoU above which boxes of one class count as one object.
 *   max_detections (an int 1..=1000, live, default 100): Maximum number of boxes per image.
 *   suppression (a str, one of hard, soft, fast, cluster, live, default hard): Method of non-maximum suppression.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   boxes (BoundingBoxList)
 */
static inline opendr_status opendr_load_nanodet(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("nanodet", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_nanodet(const opendr_learner *learner,
    const opendr_image *image,
    opendr_bounding_box_list **boxes) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "boxes";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (boxes != NULL) *boxes = (opendr_bounding_box_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * YoloxLearner: YOLOX, an anchor-free detector; the most precise light detector of the 80 COCO classes, trainable on own ones.
 *
 * Parameters:
 *   threshold (a float 0..=1, live, default 0.3): Score below which detections are dropped.
 *   iou_threshold (a float 0..=1, live, default 0.45): IoU above which boxes of one class count as one object.
 *   max_detections (an int 1..=1000, live, default 100): Maximum number of boxes per image.
 *   multi_label (a bool, live, default true): Whether a cell may be a detection of several classes, or of that with the highest score only.
 *   suppression (a str, one of hard, soft, fast, cluster, live, default hard): Method of non-maximum suppression.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   boxes (BoundingBoxList)
 */
static inline opendr_status opendr_load_yolox(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("yolox", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_yolox(const opendr_learner *learner,
    const opendr_image *image,
    opendr_bounding_box_list **boxes) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "boxes";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (boxes != NULL) *boxes = (opendr_bounding_box_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * FastestDetLearner: FastestDet detects the 80 COCO classes with a network of 1 MB; the fastest detector, for small processors.
 *
 * Parameters:
 *   threshold (a float 0..=1, live, default 0.4): Score below which detections are dropped.
 *   iou_threshold (a float 0..=1, live, default 0.45): IoU above which boxes of one class count as one object.
 *   max_detections (an int 1..=1000, live, default 100): Maximum number of boxes per image.
 *   suppression (a str, one of hard, soft, fast, cluster, live, default hard): Method of non-maximum suppression.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   boxes (BoundingBoxList)
 */
static inline opendr_status opendr_load_fastest_det(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("fastest_det", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_fastest_det(const opendr_learner *learner,
    const opendr_image *image,
    opendr_bounding_box_list **boxes) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "boxes";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (boxes != NULL) *boxes = (opendr_bounding_box_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * ImportedDetectorLearner: Runs your own detector, exported to ONNX by another tool; recognises the layout of its outputs.
 *
 * Parameters:
 *   threshold (a float 0..=1, live, default 0.25): Score below which detections are dropped.
 *   iou_threshold (a float 0..=1, live, default 0.65): IoU above which candidates of one class count as one object; detections and queries are not suppressed.
 *   max_detections (an int 1..=1000, live, default 300): Maximum number of boxes per image.
 *   multi_label (a bool, live, default false): Whether a candidate may be a detection of several classes, or of that with the highest score only.
 *   suppression (a str, one of hard, soft, fast, cluster, live, default hard): Method of non-maximum suppression of upright candidates; rotated ones have Fast NMS by the probabilistic IoU.
 *   layout (a str, one of auto, candidates, grid_candidates, detections, queries, default auto): What the rows of the outputs are.
 *   boxes (a str, one of auto, xyxy, cxcywh, xywh, yxyx, default auto): The four values of a box.
 *   unit (a str, one of auto, pixels, fractions, default auto): Unit of boxes.
 *   scores (a str, one of auto, probabilities, sigmoid, softmax, default auto): What the class scores are.
 *   objectness (a str, one of auto, present, absent, default auto): Whether rows of candidates have an objectness.
 *   row_order (a str, one of auto, box_score_class, class_score_box, batch_box_class_score, batch_box_score_class, default auto): Order of the values of a detection in one output.
 *   angle (a str, one of auto, absent, last, default auto): Whether the boxes are rotated; the segment of a rotated box is its polygon.
 *   masks (a str, one of auto, absent, prototypes, default auto): Whether the detections have masks.
 *   first_class (an int 0..=1000, default none): Class index of the network that is the first of the class names; recognised from the network if absent.
 *   resize (a str, one of auto, letterbox, top_left, top_left_truncated, stretch, default auto): How an image becomes the network's input.
 *   padding (an int 0..=255, default none): Level of the padding of a letterbox; recognised from the network if absent.
 *   colour (a str, one of auto, rgb, bgr, default auto): Order of the colour channels of the network's input.
 *   levels (a str, one of auto, 0_255, 0_1, -1_1, imagenet, clip, default auto): Range of the samples of the network's input.
 *   size (an int 32..=4096 px, default none): Side of the network's input, for models of dynamic size; if absent that of its convention, 640 for most.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   boxes (BoundingBoxList)
 */
static inline opendr_status opendr_load_detector(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("detector", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_detector(const opendr_learner *learner,
    const opendr_image *image,
    opendr_bounding_box_list **boxes) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "boxes";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (boxes != NULL) *boxes = (opendr_bounding_box_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * SingleShotDetectorLearner: SSD on MobileNetV1, a small detector, trainable on own classes.
 *
 * Parameters:
 *   threshold (a float 0..=1, live, default 0.2): Score below which detections are dropped.
 *   iou_threshold (a float 0..=1, live, default 0.45): IoU above which boxes of one class count as one object.
 *   max_candidates (an int 1..=1000, live, default 400): Number of candidates with the highest scores that enter the suppression.
 *   max_detections (an int 1..=1000, live, default 100): Maximum number of boxes per image.
 *   suppression (a str, one of hard, soft, fast, cluster, live, default hard): Method of non-maximum suppression.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   boxes (BoundingBoxList)
 */
static inline opendr_status opendr_load_single_shot_detector(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("single_shot_detector", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_single_shot_detector(const opendr_learner *learner,
    const opendr_image *image,
    opendr_bounding_box_list **boxes) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "boxes";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (boxes != NULL) *boxes = (opendr_bounding_box_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * TiledDetectionLearner: Runs any detector on the relevant tiles of large images, within a time budget.
 *
 * Parameters:
 *   threshold (a float 0..=1, live, default 0.35): Score below which detections are dropped; the detector itself drops those below 0.1.
 *   iou_threshold (a float 0..=1, live, default 0.5): IoU above which boxes of one class from different tiles count as one object.
 *   max_detections (an int 1..=2000, live, default 500): Maximum number of boxes per image.
 *   tile (an int 32..=4096 px, live, default 256): Side of a tile in the image. Objects should cover a tenth of it or more.
 *   tile_overlap (an int 0..=2048 px, live, default 48): Overlap of neighbouring tiles: a smaller object is completely in one of them. At most half of a tile counts.
 *   whole (a bool, live, default true): Whether the whole image is processed too, for objects larger than a tile.
 *   time_budget (a float 0..=60000 ms, live, default 0): Time budget per image. A tile in progress is finished, and one is always processed. With 0 there is no limit, and the results are deterministic.
 *   max_tiles (an int 0..=100000, live, default 0): Maximum number of tiles per image; the others are processed in the next images. 0: no limit.
 *   detail_threshold (a float 0..=255, live, default 16): Range of brightness within 16 pixels, 0..=255, up to which a tile is empty; 0: no tile is.
 *   change_threshold (a float 0..=255, live, default 6): Change of the brightness of 16 x 16 pixels, 0..=255, above which a tile is processed again; until then its last result is valid. 0: always.
 *   memory (an int 0..=1000, live, default 5): Number of images for which the last result of a changed tile stays valid, if there is no time to process it again.
 *   rotation (an int 0..=1000, live, default 4): Number of images after which the tile that was processed longest ago is processed again, in any case; 0: never.
 *   parallel_tiles (an int 0..=64, default 0): Number of tiles that are processed in parallel, each on a thread with a copy of the network; 0: the number of cores, at most four.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   boxes (BoundingBoxList)
 */
static inline opendr_status opendr_load_tiled_detection(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("tiled_detection", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_tiled_detection(const opendr_learner *learner,
    const opendr_image *image,
    opendr_bounding_box_list **boxes) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "boxes";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (boxes != NULL) *boxes = (opendr_bounding_box_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * Seq2SeqNMSLearner: Learned non-maximum suppression of a detector's boxes, by geometry and appearance; trainable.
 *
 * Parameters:
 *   threshold (a float 0..=1, live, default 0.1): New score below which boxes are dropped.
 *   iou_filtering (a float 0..=1, live, default 0.8): IoU above which only the box with the highest score enters the network.
 *   max_dt_boxes (an int 1..=1000, live, default 400): Maximum number of boxes that enter the network, highest scores first.
 *
 * Inputs:
 *   image (Image): Image.
 *   detections (BoundingBoxList): Boxes before suppression; boxes of classes that the model does not have are dropped.
 *
 * Outputs:
 *   boxes (BoundingBoxList)
 */
static inline opendr_status opendr_load_seq2seq_nms(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("seq2seq_nms", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_seq2seq_nms(const opendr_learner *learner,
    const opendr_image *image,
    const opendr_bounding_box_list *detections,
    opendr_bounding_box_list **boxes) {
    opendr_input inputs_[2];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    inputs_[1].name = "detections";
    inputs_[1].value = (const opendr_value *)detections;
    outputs_[0].name = "boxes";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 2, outputs_, 1);
    if (boxes != NULL) *boxes = (opendr_bounding_box_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * GemLearner: Detects objects in a colour and an infrared image and predicts the weight of each sensor; trainable.
 *
 * Parameters:
 *   threshold (a float 0..=1, live, default 0.3): Score below which detections are dropped. OpenDR's default of 0.7 is for the scores of DETR.
 *   iou_threshold (a float 0..=1, live, default 0.45): IoU above which boxes of one class count as one object.
 *   max_detections (an int 1..=1000, live, default 100): Maximum number of boxes per pair of images.
 *
 * Inputs:
 *   colour (Image): Colour image. Boxes are in its pixels.
 *   infrared (Image): Image of the infrared sensor (or of another, as in training) with the same view. Its size may differ; points correspond by their relative positions.
 *
 * Outputs:
 *   boxes (BoundingBoxList): Detections, in pixels of the colour image.
 *   sensors (Category): Weights of the sensors, of sum one: class 0 is colour, 1 infrared (OpenDR's `weight1` and `weight2`).
 */
static inline opendr_status opendr_load_gem(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("gem", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_gem(const opendr_learner *learner,
    const opendr_image *colour,
    const opendr_image *infrared,
    opendr_bounding_box_list **boxes,
    opendr_category **sensors) {
    opendr_input inputs_[2];
    opendr_output outputs_[2];
    opendr_status status_;
    inputs_[0].name = "colour";
    inputs_[0].value = (const opendr_value *)colour;
    inputs_[1].name = "infrared";
    inputs_[1].value = (const opendr_value *)infrared;
    outputs_[0].name = "boxes";
    outputs_[0].value = NULL;
    outputs_[1].name = "sensors";
    outputs_[1].value = NULL;
    status_ = opendr_infer(learner, inputs_, 2, outputs_, 2);
    if (boxes != NULL) *boxes = (opendr_bounding_box_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    if (sensors != NULL) *sensors = (opendr_category *)outputs_[1].value;
    else opendr_value_free(&outputs_[1].value);
    return status_;
}

/*
 * VoxelObjectDetection3DLearner: PointPillars detects 3D boxes in lidar scans; trainable on your own classes.
 *
 * Parameters:
 *   threshold (a float 0..=1, live, default 0.3): Minimum score of a box. OpenDR's default is 0.
 *   iou_threshold (a float 0..=1, live, default 0.1): IoU on the ground above which boxes of one class are suppressed.
 *   max_candidates (an int 1..=10000, live, default 400): Maximum number of boxes before non-maximum suppression, those with the highest scores.
 *   max_detections (an int 1..=1000, live, default 100): Maximum number of boxes per scan.
 *
 * Inputs:
 *   point_cloud (PointCloud): Scan of a lidar; with a PointCloudWithCalibration, the boxes are in its camera's frame and image.
 *
 * Outputs:
 *   boxes_3d (BoundingBox3DList)
 */
static inline opendr_status opendr_load_voxel_object_detection_3d(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("voxel_object_detection_3d", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_voxel_object_detection_3d(const opendr_learner *learner,
    const opendr_point_cloud *point_cloud,
    opendr_bounding_box_3d_list **boxes_3d) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "point_cloud";
    inputs_[0].value = (const opendr_value *)point_cloud;
    outputs_[0].name = "boxes_3d";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (boxes_3d != NULL) *boxes_3d = (opendr_bounding_box_3d_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * SortLearner: SORT tracks the detections of any detector by motion and overlap only, at very low cost.
 *
 * Parameters:
 *   threshold (a float 0..=1, live, default 0.3): Score below which detections are ignored.
 *   iou_threshold (a float 0.01..=1, live, default 0.3): Minimum IoU of a track and its detection.
 *   max_age (an int 0..=1000, live, default 1): Number of frames that a track is kept without a detection.
 *   min_hits (an int 1..=100, live, default 3): Number of detections in a row that confirm a track; in the first frames of a stream, one.
 *   per_class (a bool, live, default true): Whether only boxes of the same class match.
 *
 * Inputs:
 *   detections (BoundingBoxList): Detections in the frame, with their scores.
 *   image (Image): Frame, from which the motion of the camera is estimated. Either all frames of a stream have one, or none. Optional: may be NULL.
 *
 * Outputs:
 *   tracks (TrackingAnnotationList)
 */
static inline opendr_status opendr_load_sort(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("sort", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_sort(const opendr_learner *learner,
    const opendr_bounding_box_list *detections,
    const opendr_image *image,
    opendr_tracking_annotation_list **tracks) {
    opendr_input inputs_[2];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "detections";
    inputs_[0].value = (const opendr_value *)detections;
    inputs_[1].name = "image";
    inputs_[1].value = (const opendr_value *)image;
    outputs_[0].name = "tracks";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 2, outputs_, 1);
    if (tracks != NULL) *tracks = (opendr_tracking_annotation_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * ByteTrackLearner: ByteTrack tracks the detections of any detector, also through crowds, with detections of low scores.
 *
 * Parameters:
 *   threshold (a float 0..=1, live, default 0.6): Score above which detections are associated first.
 *   low_threshold (a float 0..=1, live, default 0.1): Score above which detections resume tracks.
 *   new_threshold (a float 0..=1, live, default 0.7): Score above which a detection starts a track.
 *   iou_threshold (a float 0.01..=1, live, default 0.2): Minimum of IoU times score of a track and its detection.
 *   low_iou_threshold (a float 0.01..=1, live, default 0.5): Minimum IoU of a track and its detection of a low score.
 *   track_buffer (an int 0..=1000, live, default 30): Number of frames that a track is kept without a detection.
 *   min_hits (an int 1..=100, live, default 2): Number of detections in a row that confirm a track; in the first frames of a stream, one.
 *   per_class (a bool, live, default true): Whether only boxes of the same class match.
 *
 * Inputs:
 *   detections (BoundingBoxList): Detections in the frame, with their scores.
 *   image (Image): Frame, from which the motion of the camera is estimated. Either all frames of a stream have one, or none. Optional: may be NULL.
 *
 * Outputs:
 *   tracks (TrackingAnnotationList)
 */
static inline opendr_status opendr_load_byte_track(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("byte_track", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_byte_track(const opendr_learner *learner,
    const opendr_bounding_box_list *detections,
    const opendr_image *image,
    opendr_tracking_annotation_list **tracks) {
    opendr_input inputs_[2];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "detections";
    inputs_[0].value = (const opendr_value *)detections;
    inputs_[1].name = "image";
    inputs_[1].value = (const opendr_value *)image;
    outputs_[0].name = "tracks";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 2, outputs_, 1);
    if (tracks != NULL) *tracks = (opendr_tracking_annotation_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * OcSortLearner: OC-SORT tracks the detections of any detector through occlusions and non-linear motion.
 *
 * Parameters:
 *   threshold (a float 0..=1, live, default 0.6): Score below which detections are ignored.
 *   iou_threshold (a float 0.01..=1, live, default 0.3): Minimum IoU of a track and its detection.
 *   max_age (an int 0..=1000, live, default 30): Number of frames that a track is kept without a detection.
 *   min_hits (an int 1..=100, live, default 3): Number of detections in a row that confirm a track; in the first frames of a stream, one.
 *   delta_t (an int 1..=10, live, default 3): Number of frames over which directions are measured.
 *   inertia (a float 0..=1, live, default 0.2): Weight of the direction, relative to the overlap.
 *   per_class (a bool, live, default true): Whether only boxes of the same class match.
 *
 * Inputs:
 *   detections (BoundingBoxList): Detections in the frame, with their scores.
 *   image (Image): Frame, from which the motion of the camera is estimated. Either all frames of a stream have one, or none. Optional: may be NULL.
 *
 * Outputs:
 *   tracks (TrackingAnnotationList)
 */
static inline opendr_status opendr_load_oc_sort(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("oc_sort", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_oc_sort(const opendr_learner *learner,
    const opendr_bounding_box_list *detections,
    const opendr_image *image,
    opendr_tracking_annotation_list **tracks) {
    opendr_input inputs_[2];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "detections";
    inputs_[0].value = (const opendr_value *)detections;
    inputs_[1].name = "image";
    inputs_[1].value = (const opendr_value *)image;
    outputs_[0].name = "tracks";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 2, outputs_, 1);
    if (tracks != NULL) *tracks = (opendr_tracking_annotation_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * CBiouLearner: C-BIoU tracks the detections of any detector by the overlap of enlarged boxes, also through sudden motion.
 *
 * Parameters:
 *   threshold (a float 0..=1, live, default 0.3): Score below which detections are ignored.
 *   small_buffer (a float 0..=2, live, default 0.3): Enlargement of the boxes in the first pass, on each side, as a fraction of width and height.
 *   large_buffer (a float 0..=2, live, default 0.4): Enlargement in the second pass, for the tracks and detections that the first one left.
 *   iou_threshold (a float 0.01..=1, live, default 0.3): Minimum IoU of the enlarged boxes of a track and its detection.
 *   motion_window (an int 1..=16, live, default 5): Number of detections whose mean motion is extrapolated; 1 for none.
 *   max_age (an int 0..=1000, live, default 30): Number of frames that a track is kept without a detection.
 *   min_hits (an int 1..=100, live, default 3): Number of detections in a row that confirm a track; in the first frames of a stream, one.
 *   per_class (a bool, live, default true): Whether only boxes of the same class match.
 *
 * Inputs:
 *   detections (BoundingBoxList): Detections in the frame, with their scores.
 *   image (Image): Frame, from which the motion of the camera is estimated. Either all frames of a stream have one, or none. Optional: may be NULL.
 *
 * Outputs:
 *   tracks (TrackingAnnotationList)
 */
static inline opendr_status opendr_load_c_biou(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("c_biou", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_c_biou(const opendr_learner *learner,
    const opendr_bounding_box_list *detections,
    const opendr_image *image,
    opendr_tracking_annotation_list **tracks) {
    opendr_input inputs_[2];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "detections";
    inputs_[0].value = (const opendr_value *)detections;
    inputs_[1].name = "image";
    inputs_[1].value = (const opendr_value *)image;
    outputs_[0].name = "tracks";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 2, outputs_, 1);
    if (tracks != NULL) *tracks = (opendr_tracking_annotation_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * ObjectTracking2DDeepSortLearner: DeepSORT tracks the persons that a detector detects and re-identifies them by appearance.
 *
 * Parameters:
 *   max_dist (a float 0..=2, live, default 0.2): Maximum distance of the embeddings of a track and its detection (1 minus the cosine).
 *   min_confidence (a float 0..=1, live, default 0.3): Score below which detections are ignored.
 *   nms_max_overlap (a float 0..=1, live, default 0.5): IoU above which only the box with the highest score is kept.
 *   max_iou_distance (a float 0..=0.99, live, default 0.7): Maximum of 1 minus IoU of a track and its detection, where embeddings do not match.
 *   max_age (an int 0..=1000, live, default 70): Number of frames that a track is kept without a detection.
 *   n_init (an int 1..=100, live, default 3): Number of detections in a row that confirm a track; in the first frames of a stream, one.
 *   nn_budget (an int 1..=200, live, default 100): Number of embeddings that are stored per track.
 *   per_class (a bool, live, default true): Whether only boxes of the same class match.
 *   colour (a str, one of auto, rgb, bgr, default auto): Order of the colour channels of the network's input; `auto` is that of the model's manifest.
 *   levels (a str, one of auto, 0_255, 0_1, -1_1, imagenet, clip, default auto): Range of the samples of the network's input; `auto` is that of the model's manifest.
 *
 * Inputs:
 *   image (Image): Frame.
 *   detections (BoundingBoxList): Detections in the frame.
 *
 * Outputs:
 *   tracks (TrackingAnnotationList)
 */
static inline opendr_status opendr_load_deep_sort(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("deep_sort", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_deep_sort(const opendr_learner *learner,
    const opendr_image *image,
    const opendr_bounding_box_list *detections,
    opendr_tracking_annotation_list **tracks) {
    opendr_input inputs_[2];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    inputs_[1].name = "detections";
    inputs_[1].value = (const opendr_value *)detections;
    outputs_[0].name = "tracks";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 2, outputs_, 1);
    if (tracks != NULL) *tracks = (opendr_tracking_annotation_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * ObjectTracking2DFairMotLearner: NanoDet and ByteTrack in one learner track the persons in a video.
 *
 * Parameters:
 *   threshold (a float 0.1..=1, live, default 0.3): Score above which detections are associated first; 0.1 more starts a track.
 *   track_buffer (an int 0..=1000, live, default 30): Number of frames that a track is kept without a detection.
 *   min_box_area (a float 0..=1000000 px^2, live, default 100): Area below which boxes are ignored.
 *   every_class (a bool, live, default false): Whether all classes of the detector are tracked, instead of persons only.
 *   camera_motion (a bool, live, default true): Whether the motion of the camera is compensated; a fixed camera does not need it.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   tracks (TrackingAnnotationList)
 */
static inline opendr_status opendr_load_fair_mot(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("fair_mot", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_fair_mot(const opendr_learner *learner,
    const opendr_image *image,
    opendr_tracking_annotation_list **tracks) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "tracks";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (tracks != NULL) *tracks = (opendr_tracking_annotation_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * SiamRPNLearner: NanoTrack tracks one object of any class from a box in the first frame.
 *
 * Parameters:
 *   window_influence (a float 0..=1, live, default 0.455): Weight of the window that penalises positions far from the previous one.
 *   penalty (a float 0..=1, live, default 0.138): Penalty of changes of size and aspect ratio.
 *   size_rate (a float 0..=1, live, default 0.348): Rate at which the size of the box follows the network's.
 *
 * Inputs:
 *   image (Image): Frame.
 *   init_box (BoundingBoxList): Object to track from this frame on: its first box. Given in the first call of a stream, otherwise NULL.
 *
 * Outputs:
 *   tracks (TrackingAnnotationList)
 */
static inline opendr_status opendr_load_nano_track(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("nano_track", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_nano_track(const opendr_learner *learner,
    const opendr_image *image,
    const opendr_bounding_box_list *init_box,
    opendr_tracking_annotation_list **tracks) {
    opendr_input inputs_[2];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    inputs_[1].name = "init_box";
    inputs_[1].value = (const opendr_value *)init_box;
    outputs_[0].name = "tracks";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 2, outputs_, 1);
    if (tracks != NULL) *tracks = (opendr_tracking_annotation_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * ObjectTracking3DAb3dmotLearner: AB3DMOT tracks 3D boxes by motion and shared volume.
 *
 * Parameters:
 *   max_staleness (an int 1..=1000, live, default 2): Number of steps without a detection after which a track is dropped.
 *   min_updates (an int 1..=100, live, default 3): Number of detections in a row that confirm a track; in the first steps of a stream, one.
 *   iou_threshold (a float 0..=1, live, default 0.01): Minimum IoU of the volumes of a track and its detection.
 *   per_class (a bool, live, default true): Whether only boxes of the same class match.
 *
 * Inputs:
 *   boxes_3d (BoundingBox3DList)
 *
 * Outputs:
 *   tracks_3d (TrackingAnnotation3DList)
 */
static inline opendr_status opendr_load_ab3dmot(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("ab3dmot", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_ab3dmot(const opendr_learner *learner,
    const opendr_bounding_box_3d_list *boxes_3d,
    opendr_tracking_annotation_3d_list **tracks_3d) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "boxes_3d";
    inputs_[0].value = (const opendr_value *)boxes_3d;
    outputs_[0].name = "tracks_3d";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (tracks_3d != NULL) *tracks_3d = (opendr_tracking_annotation_3d_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * ObjectTracking3DVpitLearner: VPIT tracks one object in the scans of a lidar from a box in the first one; trainable on recordings.
 *
 * Parameters:
 *   window_influence (a float 0..=1, live, default 0.4): Weight of the window that penalises positions far from the expected one.
 *   rotation_penalty (a float 0..=1, live, default 0.98): Factor of the scores of rotations other than the expected one.
 *   rotation_step (a float 0.01..=1 rad, live, default 0.15): Step between the rotations that are compared.
 *   rotations_count (an int 1..=9, live, default 3): Number of rotations that are compared, the expected one in the middle; an even number counts as one more.
 *   context_amount (a float 0..=2, default 0.25): Margin around an object, in its mean sides.
 *   target_feature_merge_scale (a float 0..=1, live, default 0): Weight of every later view in the features of the object; 0 as in OpenDR.
 *   extrapolation_mode (a str, one of linear+, linear, none, live, default linear+): Prediction of the object's position.
 *   offset_interpolation (a float 0..=1, live, default 1): Share of the offset to the detected position by which the box moves.
 *   vertical_offset_interpolation (a float 0..=1, live, default 0.5): Share of the vertical offset by which the box moves.
 *   min_top_score (a float 0..=1, live, default 0): Score below which the object counts as lost: the box moves to the expected position.
 *
 * Inputs:
 *   point_cloud (PointCloud): Scan of a lidar; with a PointCloudWithCalibration, the boxes are in its camera's frame and image.
 *   init_box (BoundingBox3DList): Object to track from this scan on: its first box. Given in the first call of a stream, otherwise NULL.
 *
 * Outputs:
 *   tracks_3d (TrackingAnnotation3DList)
 */
static inline opendr_status opendr_load_vpit(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("vpit", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_vpit(const opendr_learner *learner,
    const opendr_point_cloud *point_cloud,
    const opendr_bounding_box_3d_list *init_box,
    opendr_tracking_annotation_3d_list **tracks_3d) {
    opendr_input inputs_[2];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "point_cloud";
    inputs_[0].value = (const opendr_value *)point_cloud;
    inputs_[1].name = "init_box";
    inputs_[1].value = (const opendr_value *)init_box;
    outputs_[0].name = "tracks_3d";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 2, outputs_, 1);
    if (tracks_3d != NULL) *tracks_3d = (opendr_tracking_annotation_3d_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * UltraLightFaceLearner: Ultra-Light RFB detects faces in a few milliseconds; boxes only.
 *
 * Parameters:
 *   threshold (a float 0..=1, live, default 0.7): Score below which faces are dropped.
 *   iou_threshold (a float 0..=1, live, default 0.3): IoU above which boxes count as one face.
 *   max_detections (an int 1..=1000, live, default 200): Maximum number of faces per image.
 *   suppression (a str, one of hard, soft, fast, cluster, live, default hard): Method of non-maximum suppression.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   boxes (BoundingBoxList)
 */
static inline opendr_status opendr_load_ultra_light_face(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("ultra_light_face", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_ultra_light_face(const opendr_learner *learner,
    const opendr_image *image,
    opendr_bounding_box_list **boxes) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "boxes";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (boxes != NULL) *boxes = (opendr_bounding_box_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * YunetLearner: YuNet detects faces with eyes, nose and corners of the mouth; tiny and fast.
 *
 * Parameters:
 *   threshold (a float 0..=1, live, default 0.6): Score below which faces are dropped.
 *   iou_threshold (a float 0..=1, live, default 0.3): IoU above which boxes count as one face.
 *   max_detections (an int 1..=1000, live, default 200): Maximum number of faces per image.
 *   size (an int 32..=4096 px, default 640): Side of the network's input, for models of dynamic size; a multiple of 32.
 *   suppression (a str, one of hard, soft, fast, cluster, live, default hard): Method of non-maximum suppression.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   boxes (BoundingBoxList)
 */
static inline opendr_status opendr_load_yunet(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("yunet", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_yunet(const opendr_learner *learner,
    const opendr_image *image,
    opendr_bounding_box_list **boxes) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "boxes";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (boxes != NULL) *boxes = (opendr_bounding_box_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * FaceRecognitionLearner: MobileFace recognises the persons in an image by their faces, from a few reference images of each.
 *
 * Parameters:
 *   threshold (a float -1..=1, live, default 0.38): Cosine to every image of a known person below which a face is unknown.
 *   face_threshold (a float 0..=1, default 0.6): Score of the detector below which faces are dropped.
 *   input_kind (a str, one of frame, face, live, default frame): Content of the images.
 *   colour (a str, one of auto, rgb, bgr, default auto): Order of the colour channels of the network's input; `auto` is that of the model's manifest.
 *   levels (a str, one of auto, 0_255, 0_1, -1_1, imagenet, clip, default auto): Range of the samples of the network's input; `auto` is that of the model's manifest.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   boxes (BoundingBoxList)
 */
static inline opendr_status opendr_load_face_recognition(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("face_recognition", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_face_recognition(const opendr_learner *learner,
    const opendr_image *image,
    opendr_bounding_box_list **boxes) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "boxes";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (boxes != NULL) *boxes = (opendr_bounding_box_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * FaceMeshLearner: MediaPipe's face mesh: 468 points of a face and its irises, tracked from frame to frame.
 *
 * Parameters:
 *   threshold (a float 0..=1, live, default 0.5): Score of the mesh below which faces are dropped.
 *   face_threshold (a float 0..=1, default 0.6): Score of the detector below which faces are dropped.
 *   max_faces (an int 1..=50, live, default 1): Maximum number of faces per image; the detector runs on frames with fewer.
 *   track (a bool, live, default true): Whether faces are tracked from frame to frame; otherwise the detector runs on each frame.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   poses (PoseList)
 */
static inline opendr_status opendr_load_face_mesh(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("face_mesh", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_face_mesh(const opendr_learner *learner,
    const opendr_image *image,
    opendr_pose_list **poses) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "poses";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (poses != NULL) *poses = (opendr_pose_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * FacialEmotionLearner: mini-XCEPTION classifies the emotion of the largest face in an image, one of seven.
 *
 * Parameters:
 *   face_threshold (a float 0..=1, default 0.6): Score of the detector below which faces are dropped.
 *   input_kind (a str, one of frame, face, live, default frame): Content of the images.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   category (Category)
 */
static inline opendr_status opendr_load_facial_emotion(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("facial_emotion", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_facial_emotion(const opendr_learner *learner,
    const opendr_image *image,
    opendr_category **category) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "category";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (category != NULL) *category = (opendr_category *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * ProgressiveSpatioTemporalBLNLearner: PST-BLN classifies facial expressions from sequences of landmarks; its network grows in the training.
 *
 * Parameters:
 *   num_class (an int 2..=10000, default none): Number of classes; by default that of the data set.
 *   num_point (an int 2..=1000, default none): Number of landmarks of a face; by default that of the data set.
 *   in_channels (an int 2..=3, default 2): Coordinates of a landmark: 2 (an optional third channel has scores) or 3.
 *   num_frames (an int 1..=10000, default 20): Frames of a clip: the last ones of a longer recording; a shorter one is extended by its first frame.
 *   blocksize (an int 1..=256, default 5): Output channels of a block.
 *   num_blocks (an int 1..=1000, default 100): Maximum number of blocks of a layer of a network that grows.
 *   num_layers (an int 1..=100, default 10): Maximum number of layers of a network that grows.
 *   topology (a list 1..=1000, default ): Number of blocks of each layer. Empty: `fit` finds it; the network grows while its training loss decreases.
 *   layer_threshold (a float 0..=1, default 0.0001): Relative decrease of the training loss that a further layer must exceed.
 *   block_threshold (a float 0..=1, default 0.0001): Relative decrease of the training loss that a further block must exceed.
 *
 * Inputs:
 *   skeleton_sequence (SkeletonSequence)
 *
 * Outputs:
 *   category (Category)
 */
static inline opendr_status opendr_load_progressive_spatio_temporal_bln(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("progressive_spatio_temporal_bln", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_progressive_spatio_temporal_bln(const opendr_learner *learner,
    const opendr_skeleton_sequence *skeleton_sequence,
    opendr_category **category) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "skeleton_sequence";
    inputs_[0].value = (const opendr_value *)skeleton_sequence;
    outputs_[0].name = "category";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (category != NULL) *category = (opendr_category *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * MovenetLearner: MoveNet detects 18 joints of one person (lightning) or of up to six (multipose).
 *
 * Parameters:
 *   threshold (a float 0..=1, live, default 0.2): Score below which persons are dropped.
 *   keypoint_threshold (a float 0..=1, live, default 0.1): Score below which joints are missing.
 *   size (an int 128..=1024 px, default 256): Longer side of the input of MultiPose; a multiple of 32. Larger values detect smaller persons.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   poses (PoseList)
 */
static inline opendr_status opendr_load_movenet(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("movenet", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_movenet(const opendr_learner *learner,
    const opendr_image *image,
    opendr_pose_list **poses) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "poses";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (poses != NULL) *poses = (opendr_pose_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * PosenetLearner: PoseNet detects 18 joints of several persons; convolutions only.
 *
 * Parameters:
 *   threshold (a float 0..=1, live, default 0.25): Score below which persons are dropped.
 *   keypoint_threshold (a float 0..=1, live, default 0.1): Score below which joints are missing.
 *   peak_threshold (a float 0.01..=0.99, live, default 0.5): Score below which joints start no person.
 *   nms_radius (a float 0..=200 px, live, default 20): Distance below which joints of one kind belong to one person, in pixels of the network's input.
 *   max_detections (an int 1..=100, live, default 20): Maximum number of persons per image.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   poses (PoseList)
 */
static inline opendr_status opendr_load_posenet(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("posenet", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_posenet(const opendr_learner *learner,
    const opendr_image *image,
    opendr_pose_list **poses) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "poses";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (poses != NULL) *poses = (opendr_pose_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * LightweightOpenPoseLearner: Lightweight OpenPose detects and tracks 18 joints of several persons; trainable.
 *
 * Parameters:
 *   threshold (a float 0..=1, live, default 0.1): Score below which persons are dropped. The score is the mean over the 18 joints; missing ones count as 0.
 *   keypoint_threshold (a float 0.01..=1, live, default 0.1): Score below which joints are missing.
 *   base_height (an int 64..=2048 px, live, default 256): Height of the network's input; its width follows from the image. Larger values detect smaller persons.
 *   upsample_ratio (an int 1..=8, live, default 4): Upsampling factor of the heatmaps for the search of joints.
 *   track (a bool, live, default true): Whether persons keep their identity from frame to frame.
 *   smooth (a bool, live, default true): Whether joints are smoothed over frames; needs `track`.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   poses (PoseList)
 */
static inline opendr_status opendr_load_lightweight_open_pose(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("lightweight_open_pose", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_lightweight_open_pose(const opendr_learner *learner,
    const opendr_image *image,
    opendr_pose_list **poses) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "poses";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (poses != NULL) *poses = (opendr_pose_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * HighResolutionPoseEstimationLearner: Pose estimation in large images in two passes: coarse, then finer where persons may be.
 *
 * Parameters:
 *   first_pass_height (an int 64..=2048 px, live, default 360): Height of the network's input for the whole image.
 *   second_pass_height (an int 64..=2048 px, live, default 540): Maximum height of the network's input for a region; small regions are magnified three times.
 *   method (a str, one of adaptive, primary, live, default adaptive): Selection of regions.
 *   percentage_around_crop (a float 0..=2, live, default 0.3): Margin around a region on each side, as a share of its longer side.
 *   heatmap_threshold (a float 0.01..=1, live, default 0.1): Value of the coarse heatmaps above which a cell is selected.
 *   detail_threshold (a float 1..=256, live, default 32): Range of brightness within 4 pixels of the coarse image above which a cell is selected, 0..=255; 256 switches it off.
 *   max_regions (an int 1..=64, live, default 4): Maximum number of regions per image; the others follow in the next frames.
 *   max_pixels (an int 1..=100000000 px, live, default 300000): Maximum number of pixels of the network's inputs for the regions of an image; the first region is always processed.
 *   threshold (a float 0..=1, live, default 0.1): Score below which persons are dropped.
 *   keypoint_threshold (a float 0.01..=1, live, default 0.1): Score below which joints are missing.
 *   upsample_ratio (an int 1..=8, live, default 4): Upsampling factor of the heatmaps for the search of joints.
 *   track (a bool, live, default true): Whether persons keep their identity from frame to frame.
 *   smooth (a bool, live, default true): Whether joints are smoothed over frames; needs `track`.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   poses (PoseList)
 */
static inline opendr_status opendr_load_high_resolution_pose_estimation(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("high_resolution_pose_estimation", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_high_resolution_pose_estimation(const opendr_learner *learner,
    const opendr_image *image,
    opendr_pose_list **poses) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "poses";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (poses != NULL) *poses = (opendr_pose_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * BlazePoseLearner: BlazePose detects and tracks 33 keypoints of one person, including hands, feet and face.
 *
 * Parameters:
 *   threshold (a float 0..=1, live, default 0.5): Score below which the person is dropped and not tracked further.
 *   keypoint_threshold (a float 0..=1, live, default 0.1): Probability of visibility below which keypoints are missing.
 *   passes (an int 1..=4, live, default 2): Number of passes for a person who is not tracked yet; each pass starts from the square of the previous one.
 *   track (a bool, live, default true): Whether the person is tracked from frame to frame; switch it off for single images.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   poses (PoseList)
 */
static inline opendr_status opendr_load_blazepose(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("blazepose", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_blazepose(const opendr_learner *learner,
    const opendr_image *image,
    opendr_pose_list **poses) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "poses";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (poses != NULL) *poses = (opendr_pose_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * ImportedPoseEstimatorLearner: Runs your own pose estimator, exported to ONNX by another tool; recognises the layout of its outputs.
 *
 * Parameters:
 *   threshold (a float 0..=1, live, default 0.25): Score below which poses are dropped.
 *   keypoint_threshold (a float 0..=1, live, default 0.5): Score below which keypoints are missing.
 *   iou_threshold (a float 0..=1, live, default 0.65): IoU of the boxes above which candidates of one class count as one object; detections are not suppressed.
 *   max_poses (an int 1..=1000, live, default 100): Maximum number of poses per image.
 *   suppression (a str, one of hard, soft, fast, cluster, live, default hard): Method of non-maximum suppression of candidates.
 *   layout (a str, one of auto, candidates, detections, lists, default auto): What the outputs are.
 *   keypoints (an int 1..=144, default none): Number of keypoints of a pose; recognised from the network if absent.
 *   keypoint_values (an int 2..=3, default none): Number of values of a keypoint: 2 (position) or 3 (position and score); recognised from the network if absent.
 *   skeleton (a str, one of auto, coco17, blazepose33, left_hand21, right_hand21, points, default auto): Skeleton of the keypoints.
 *   resize (a str, one of auto, letterbox, top_left, top_left_truncated, stretch, default auto): How an image becomes the network's input.
 *   padding (an int 0..=255, default none): Level of the padding of a letterbox; recognised from the network if absent.
 *   colour (a str, one of auto, rgb, bgr, default auto): Order of the colour channels of the network's input.
 *   levels (a str, one of auto, 0_255, 0_1, -1_1, imagenet, clip, default auto): Range of the samples of the network's input.
 *   size (an int 32..=4096 px, default none): Side of the network's input, for models of dynamic size; if absent that of its convention, 640 for most.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   poses (PoseList)
 */
static inline opendr_status opendr_load_pose_estimator(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("pose_estimator", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_pose_estimator(const opendr_learner *learner,
    const opendr_image *image,
    opendr_pose_list **poses) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "poses";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (poses != NULL) *poses = (opendr_pose_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * ImportedTopDownPoseEstimatorLearner: Runs your own top-down pose estimator, exported to ONNX by another tool, on the boxes of a detector.
 *
 * Parameters:
 *   threshold (a float 0..=1, live, default 0.3): Score of a box below which no pose is estimated in it.
 *   keypoint_threshold (a float 0..=1, live, default 0.3): Score below which keypoints are missing.
 *   max_poses (an int 1..=1000, live, default 20): Maximum number of poses per image: those of the boxes with the highest scores.
 *   box_class (a str, default person): Class of the boxes in which poses are estimated; boxes without a class name are all used, and with "" those of every class.
 *   padding (a float 1..=4, live, default 1.25): Sides of the crop as a multiple of those of the box.
 *   layout (a str, one of auto, simcc, heatmaps, udp_heatmaps, default auto): What the outputs are.
 *   skeleton (a str, one of auto, coco17, blazepose33, left_hand21, right_hand21, points, default auto): Skeleton of the keypoints.
 *   colour (a str, one of auto, rgb, bgr, default auto): Order of the colour channels of the network's input.
 *   levels (a str, one of auto, 0_255, 0_1, -1_1, imagenet, clip, default auto): Range of the samples of the network's input.
 *   size (an int 32..=4096 px, default none): Side of the network's input in pixels, for models of dynamic size.
 *
 * Inputs:
 *   image (Image): Image.
 *   detections (BoundingBoxList): Boxes of persons, or of other objects; without them the image shows one person. Optional: may be NULL.
 *
 * Outputs:
 *   poses (PoseList)
 */
static inline opendr_status opendr_load_top_down_pose_estimator(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("top_down_pose_estimator", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_top_down_pose_estimator(const opendr_learner *learner,
    const opendr_image *image,
    const opendr_bounding_box_list *detections,
    opendr_pose_list **poses) {
    opendr_input inputs_[2];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    inputs_[1].name = "detections";
    inputs_[1].value = (const opendr_value *)detections;
    outputs_[0].name = "poses";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 2, outputs_, 1);
    if (poses != NULL) *poses = (opendr_pose_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * FallDetectorLearner: Detects fallen persons by a rule on their poses over time.
 *
 * Parameters:
 *   hold (a float 0..=60 s, live, default 0.5): Time after which a new posture replaces the previous one.
 *   threshold (a float 0..=1, live, default 0.1): Score below which persons are dropped.
 *   keypoint_threshold (a float 0.01..=1, live, default 0.1): Score below which joints are missing.
 *   base_height (an int 64..=2048 px, live, default 368): Height of the input of LightweightOpenPose; larger values detect smaller persons. MoveNet has its own size.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   falls (BoundingBoxList): A box around each person: class 0 for an unknown posture, 1 for a fall, 2 for none.
 *   poses (PoseList): Poses of the persons, in the order of the boxes.
 */
static inline opendr_status opendr_load_fall_detector(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("fall_detector", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_fall_detector(const opendr_learner *learner,
    const opendr_image *image,
    opendr_bounding_box_list **falls,
    opendr_pose_list **poses) {
    opendr_input inputs_[1];
    opendr_output outputs_[2];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "falls";
    outputs_[0].value = NULL;
    outputs_[1].name = "poses";
    outputs_[1].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 2);
    if (falls != NULL) *falls = (opendr_bounding_box_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    if (poses != NULL) *poses = (opendr_pose_list *)outputs_[1].value;
    else opendr_value_free(&outputs_[1].value);
    return status_;
}

/*
 * HandPoseEstimationLearner: Detects 21 joints of each hand and tracks hands through a video.
 *
 * Parameters:
 *   max_hands (an int 1..=16, live, default 2): Maximum number of hands per image.
 *   threshold (a float 0..=1, live, default 0.5): Score below which hands are dropped and not tracked further.
 *   palm_threshold (a float 0..=1, live, default 0.2): Score below which palms are dropped. Lower than MediaPipe's 0.5, as the second network rejects false palms.
 *   iou_threshold (a float 0..=1, live, default 0.3): IoU above which palms count as one.
 *   track (a bool, live, default true): Whether hands are tracked from frame to frame, each with an identity; switch it off for single images.
 *   mirrored (a bool, live, default false): Whether images are mirrored, such as selfies: left and right hands are exchanged then.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   poses (PoseList)
 */
static inline opendr_status opendr_load_hand_pose(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("hand_pose", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_hand_pose(const opendr_learner *learner,
    const opendr_image *image,
    opendr_pose_list **poses) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "poses";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (poses != NULL) *poses = (opendr_pose_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * KeypointGestureLearner: Classifies gestures from the keypoints of a hand or the path of a finger tip; trains in seconds.
 *
 * Parameters:
 *   hidden (an int 2..=1024, default 32): Features of the first layer; the second has half as many.
 *   dropout (a float 0..=0.9, default 0.1): Dropout probability.
 *
 * Inputs:
 *   vector (Vector)
 *
 * Outputs:
 *   category (Category)
 */
static inline opendr_status opendr_load_keypoint_gesture(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("keypoint_gesture", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_keypoint_gesture(const opendr_learner *learner,
    const opendr_vector *vector,
    opendr_category **category) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "vector";
    inputs_[0].value = (const opendr_value *)vector;
    outputs_[0].name = "category";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (category != NULL) *category = (opendr_category *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * HandGestureLearner: Classifies the gestures of the hands in an image, and in a video those of a pointing finger.
 *
 * Parameters:
 *   threshold (a float 0..=1, live, default 0.5): Score below which gestures are dropped.
 *   max_hands (an int 1..=16, default 2): Maximum number of hands per image.
 *   track (a bool, default true): Whether hands are tracked from frame to frame, which paths need; switch it off for single images.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   boxes (BoundingBoxList)
 */
static inline opendr_status opendr_load_hand_gesture(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("hand_gesture", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_hand_gesture(const opendr_learner *learner,
    const opendr_image *image,
    opendr_bounding_box_list **boxes) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "boxes";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (boxes != NULL) *boxes = (opendr_bounding_box_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * ImageClassifierLearner: A small image classifier; trainable on your own images in minutes.
 *
 * Parameters:
 *   probabilities (a bool, live, default true): Whether the prediction has the score of every class.
 *   softmax (a bool, default true): Whether a softmax is applied to the network's output; false for a network that ends in its own.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   category (Category)
 */
static inline opendr_status opendr_load_image_classifier(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("image_classifier", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_image_classifier(const opendr_learner *learner,
    const opendr_image *image,
    opendr_category **category) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "category";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (category != NULL) *category = (opendr_category *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * ImportedClassifierLearner: Runs your own image classifier, exported to ONNX by another tool; recognises input and scores.
 *
 * Parameters:
 *   probabilities (a bool, live, default true): Whether the prediction has the score of every class.
 *   scores (a str, one of auto, probabilities, logits, default auto): What the scores are.
 *   crop (a float 0..=1, default none): Share of the image's height or width that its central crop keeps, which has the aspect ratio of the network's input; 0 for the whole image. Networks trained on images of 256 pixels, cropped to 224, have 0.875. Recognised from the network if absent.
 *   resize (a str, one of auto, letterbox, top_left, top_left_truncated, stretch, default auto): How an image becomes the network's input.
 *   padding (an int 0..=255, default none): Level of the padding of a letterbox; recognised from the network if absent.
 *   colour (a str, one of auto, rgb, bgr, default auto): Order of the colour channels of the network's input.
 *   levels (a str, one of auto, 0_255, 0_1, -1_1, imagenet, clip, default auto): Range of the samples of the network's input.
 *   size (an int 32..=4096 px, default none): Side of the network's input, for models of dynamic size; if absent that of its convention, 640 for most.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   category (Category)
 */
static inline opendr_status opendr_load_classifier(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("classifier", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_classifier(const opendr_learner *learner,
    const opendr_image *image,
    opendr_category **category) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "category";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (category != NULL) *category = (opendr_category *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * ImportedZeroShotClassifierLearner: Classifies images by texts with your own CLIP, exported to ONNX by another tool; no training.
 *
 * Parameters:
 *   labels (a str, live, default ): Classes as texts, separated by semicolons, or by commas if there is no semicolon: `cat; dog; empty room`. The classes of the model if empty.
 *   template (a str, live, default a photo of a {}): Text that is compared with the image, with `{}` in place of the class.
 *   logit_scale (a float 0.001..=10000, live, default none): Factor on the cosine similarities of image and texts before the softmax. Read from the network if absent; 100, as that of the original CLIP, if it has none.
 *   probabilities (a bool, live, default true): Whether the prediction has the probability of every class.
 *   context_length (an int 3..=1024, default none): Number of tokens of a text, with padding. Recognised from the text network if absent; 77 if it does not state it.
 *   image_output (a str, default none): Name of the output with the vector of the image; recognised if absent.
 *   text_output (a str, default none): Name of the output with the vector of the text; recognised if absent.
 *   crop (a float 0..=1, default none): Share of the image's shorter side that its central crop keeps, which has the aspect ratio of the network's input; 0 for the whole image. Recognised from the network if absent.
 *   resize (a str, one of auto, letterbox, top_left, top_left_truncated, stretch, default auto): How an image becomes the network's input.
 *   padding (an int 0..=255, default none): Level of the padding of a letterbox; recognised from the network if absent.
 *   colour (a str, one of auto, rgb, bgr, default auto): Order of the colour channels of the network's input.
 *   levels (a str, one of auto, 0_255, 0_1, -1_1, imagenet, clip, default auto): Range of the samples of the network's input.
 *   size (an int 32..=4096 px, default none): Side of the network's input, for models of dynamic size; if absent that of its convention, 640 for most.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   category (Category)
 */
static inline opendr_status opendr_load_zero_shot_classifier(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("zero_shot_classifier", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_zero_shot_classifier(const opendr_learner *learner,
    const opendr_image *image,
    opendr_category **category) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "category";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (category != NULL) *category = (opendr_category *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * MultilinearCompressiveLearner: Classifies an image from a small multilinear measurement of it; trainable.
 *
 * Parameters:
 *   input_shape (a list 1..=4096, default 32,32,3): Height, width and channels (3) of the measured images; other images are stretched.
 *   compressed_shape (a list 1..=4096, default 16,16,1): Height, width and channels of the measurement.
 *   backbone (a str, one of small, default small): Network architecture of the classifier.
 *   n_class (an int 2..=10000, default none): Number of classes. None: the number of classes in the data set.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   category (Category)
 */
static inline opendr_status opendr_load_multilinear_compressive(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("multilinear_compressive", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_multilinear_compressive(const opendr_learner *learner,
    const opendr_image *image,
    opendr_category **category) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "category";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (category != NULL) *category = (opendr_category *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * DeeplabLearner: DeepLab v3 predicts the class of every pixel, in INT8.
 *
 * Parameters:
 *   full_size (a bool, live, default true): Whether the map has the size of the image; else it has the network's.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   heatmap (Heatmap)
 */
static inline opendr_status opendr_load_deeplab(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("deeplab", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_deeplab(const opendr_learner *learner,
    const opendr_image *image,
    opendr_heatmap **heatmap) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "heatmap";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (heatmap != NULL) *heatmap = (opendr_heatmap *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * ImportedSegmenterLearner: Runs your own semantic segmentation, exported to ONNX by another tool; recognises input and map of classes.
 *
 * Parameters:
 *   full_size (a bool, live, default true): Whether the map has the size of the image, to which scores are interpolated before the class with the highest one is chosen; else it has that of the network's output.
 *   map (a str, one of auto, channels_first, channels_last, labels, default auto): What the output has for each pixel.
 *   map_output (a str, default none): Name of the output; recognised from the network if absent.
 *   resize (a str, one of auto, letterbox, top_left, top_left_truncated, stretch, default auto): How an image becomes the network's input.
 *   padding (an int 0..=255, default none): Level of the padding of a letterbox; recognised from the network if absent.
 *   colour (a str, one of auto, rgb, bgr, default auto): Order of the colour channels of the network's input.
 *   levels (a str, one of auto, 0_255, 0_1, -1_1, imagenet, clip, default auto): Range of the samples of the network's input.
 *   size (an int 32..=4096 px, default none): Side of the network's input, for models of dynamic size; if absent that of its convention, 640 for most.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   heatmap (Heatmap)
 */
static inline opendr_status opendr_load_segmenter(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("segmenter", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_segmenter(const opendr_learner *learner,
    const opendr_image *image,
    opendr_heatmap **heatmap) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "heatmap";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (heatmap != NULL) *heatmap = (opendr_heatmap *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * BisenetLearner: BiSeNet predicts the class of every pixel; trainable on your own masks.
 *
 * Parameters:
 *   full_size (a bool, live, default true): Whether the map has the size of the image; else it has the network's.
 *   num_classes (an int 2..=255, default none): Number of classes. None: the number of classes in the data set.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   heatmap (Heatmap)
 */
static inline opendr_status opendr_load_bisenet(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("bisenet", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_bisenet(const opendr_learner *learner,
    const opendr_image *image,
    opendr_heatmap **heatmap) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "heatmap";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (heatmap != NULL) *heatmap = (opendr_heatmap *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * SelfieSegmentationLearner: Separates a person near the camera from the background.
 *
 * Parameters:
 *   threshold (a float 0..=1, live, default 0.5): Minimum probability of a pixel of the person.
 *   probabilities (a bool, live, default false): Whether the map holds probabilities, for blending, instead of classes.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   heatmap (Heatmap)
 */
static inline opendr_status opendr_load_selfie_segmentation(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("selfie_segmentation", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_selfie_segmentation(const opendr_learner *learner,
    const opendr_image *image,
    opendr_heatmap **heatmap) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "heatmap";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (heatmap != NULL) *heatmap = (opendr_heatmap *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * TiledSegmentationLearner: Predicts the class of every pixel of large images in tiles, within a time budget.
 *
 * Parameters:
 *   tile (an int 32..=4096 px, live, default 512): Side of a tile in the image. Objects should cover a tenth of it or more.
 *   tile_overlap (an int 0..=2048 px, live, default 64): Overlap of neighbouring tiles: a smaller object is completely in one of them. At most half of a tile counts.
 *   whole (a bool, live, default true): Whether the whole image is processed too, for objects larger than a tile.
 *   time_budget (a float 0..=60000 ms, live, default 0): Time budget per image. A tile in progress is finished, and one is always processed. With 0 there is no limit, and the results are deterministic.
 *   max_tiles (an int 0..=100000, live, default 0): Maximum number of tiles per image; the others are processed in the next images. 0: no limit.
 *   detail_threshold (a float 0..=255, live, default 16): Range of brightness within 16 pixels, 0..=255, up to which a tile is empty; 0: no tile is.
 *   change_threshold (a float 0..=255, live, default 6): Change of the brightness of 16 x 16 pixels, 0..=255, above which a tile is processed again; until then its last result is valid. 0: always.
 *   memory (an int 0..=1000, live, default 5): Number of images for which the last result of a changed tile stays valid, if there is no time to process it again.
 *   rotation (an int 0..=1000, live, default 4): Number of images after which the tile that was processed longest ago is processed again, in any case; 0: never.
 *   parallel_tiles (an int 0..=64, default 0): Number of tiles that are processed in parallel, each on a thread with a copy of the network; 0: the number of cores, at most four.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   heatmap (Heatmap)
 */
static inline opendr_status opendr_load_tiled_segmentation(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("tiled_segmentation", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_tiled_segmentation(const opendr_learner *learner,
    const opendr_image *image,
    opendr_heatmap **heatmap) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "heatmap";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (heatmap != NULL) *heatmap = (opendr_heatmap *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * BodyPixLearner: BodyPix detects persons with a mask each.
 *
 * Parameters:
 *   threshold (a float 0..=1, live, default 0.2): Minimum score of a person.
 *   mask_threshold (a float 0.01..=0.99, live, default 0.5): Minimum score of a pixel of a person.
 *   peak_threshold (a float 0.01..=0.99, live, default 0.4): Minimum score of a joint from which a person is decoded.
 *   nms_radius (a float 0..=200 px, live, default 30): Radius within which joints of one kind belong to one person, in pixels of the network's input.
 *   max_detections (an int 1..=100, live, default 20): Maximum number of persons per image.
 *   resolution (an int 65..=1537 px, live, default 513): Longer side of the network's input. A larger one detects smaller persons.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   boxes (BoundingBoxList)
 */
static inline opendr_status opendr_load_bodypix(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("bodypix", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_bodypix(const opendr_learner *learner,
    const opendr_image *image,
    opendr_bounding_box_list **boxes) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "boxes";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (boxes != NULL) *boxes = (opendr_bounding_box_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * ImportedPromptableSegmenterLearner: Runs Segment Anything and its small variants, exported to ONNX by another tool, on points or the boxes of a detector.
 *
 * Parameters:
 *   points (a str, live, default ): Points of one object, in pixels of the image: `x,y` or `x,y,label` each, separated by semicolons, e.g. `320,240;100,80,0`. The label is 1 for a point on the object, as without a label, and 0 for one outside.
 *   quality_threshold (a float 0..=1, live, default 0): Predicted IoU below which masks are dropped.
 *   mask_threshold (a float -50..=50, live, default 0): Logit above which pixels belong to the mask.
 *   multimask (a str, one of auto, best, single, default auto): Which of the masks of a prompt is predicted.
 *   levels (a str, one of auto, 0_255, 0_1, -1_1, imagenet, clip, default auto): Range of the samples of the encoder's input.
 *   size (an int 32..=4096 px, default none): Side of the encoder's input in pixels, for encoders of dynamic size; 1024 if absent.
 *
 * Inputs:
 *   image (Image): Image.
 *   detections (BoundingBoxList): Boxes around objects, each of which gets a mask. Optional: may be NULL.
 *
 * Outputs:
 *   boxes (BoundingBoxList)
 */
static inline opendr_status opendr_load_promptable_segmenter(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("promptable_segmenter", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_promptable_segmenter(const opendr_learner *learner,
    const opendr_image *image,
    const opendr_bounding_box_list *detections,
    opendr_bounding_box_list **boxes) {
    opendr_input inputs_[2];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    inputs_[1].name = "detections";
    inputs_[1].value = (const opendr_value *)detections;
    outputs_[0].name = "boxes";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 2, outputs_, 1);
    if (boxes != NULL) *boxes = (opendr_bounding_box_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * BinaryHighResolutionLearner: A small convolutional network detects where a high-resolution image shows the trained class; trainable.
 *
 * Parameters:
 *   architecture (a str, one of VGG_720p, VGG_1080p, default VGG_720p): Architecture of the network that is trained; a loaded model has its own.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   map (Heatmap): Probabilities `[rows, columns]`: that of row `y` and column `x` is of the square patch whose top left corner is (8x, 8y).
 *   category (Category): Class 1 where at least one patch has a probability above 0.5, with that of the best patch, else class 0. For an image of the size of a patch, the class of the patch.
 */
static inline opendr_status opendr_load_binary_high_resolution(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("binary_high_resolution", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_binary_high_resolution(const opendr_learner *learner,
    const opendr_image *image,
    opendr_heatmap **map,
    opendr_category **category) {
    opendr_input inputs_[1];
    opendr_output outputs_[2];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "map";
    outputs_[0].value = NULL;
    outputs_[1].name = "category";
    outputs_[1].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 2);
    if (map != NULL) *map = (opendr_heatmap *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    if (category != NULL) *category = (opendr_category *)outputs_[1].value;
    else opendr_value_free(&outputs_[1].value);
    return status_;
}

/*
 * EfficientPsLearner: Predicts class and instance of every pixel by fusing DeepLab, CenterNet and BodyPix.
 *
 * Parameters:
 *   threshold (a float 0..=1, live, default 0.3): Minimum score of an object.
 *   box_masks (a bool, live, default true): Whether objects of classes without a class map fill their whole boxes; else they are dropped.
 *   min_overlap (a float 0..=1, live, default 0.1): Minimum share of a box that the class map confirms.
 *   min_leftover (a float 0..=1, live, default 0.1): Minimum share of the image of a region of a thing class outside of all boxes that counts as an object.
 *   min_stuff (a float 0..=1, live, default 0.02): Minimum share of the image of a stuff region.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   instance (Heatmap): 1000 times the class plus the index of the object within its class, from 1; 0 for stuff classes. 255000 for void.
 *   semantic (Heatmap): Class of each pixel; 255 for void.
 */
static inline opendr_status opendr_load_efficient_ps(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("efficient_ps", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_efficient_ps(const opendr_learner *learner,
    const opendr_image *image,
    opendr_heatmap **instance,
    opendr_heatmap **semantic) {
    opendr_input inputs_[1];
    opendr_output outputs_[2];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "instance";
    outputs_[0].value = NULL;
    outputs_[1].name = "semantic";
    outputs_[1].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 2);
    if (instance != NULL) *instance = (opendr_heatmap *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    if (semantic != NULL) *semantic = (opendr_heatmap *)outputs_[1].value;
    else opendr_value_free(&outputs_[1].value);
    return status_;
}

/*
 * EfficientLpsLearner: Predicts class and instance of every point of a lidar scan; trainable on labelled scans.
 *
 * Parameters:
 *   things (a list, default ): Thing classes, whose objects are distinguished; a loaded model has its own.
 *   projected (a bool, live, default false): Whether the maps have the size of the range image instead of one value per point.
 *   max_gap (a float 0.01..=10 m, live, default 0.8): Maximum distance between points of neighbouring pixels of one object.
 *   min_points (an int 1..=100000, live, default 5): Minimum number of pixels of an object.
 *
 * Inputs:
 *   point_cloud (PointCloud): Scan of a lidar; with a PointCloudWithCalibration, the boxes are in its camera's frame and image.
 *
 * Outputs:
 *   instance (Heatmap): Instance of each point (`[points]`) or pixel (`[rows, columns]`): 1000 times the class plus the index of the object within its class, from 1; 0 for stuff classes. 255000 for void.
 *   semantic (Heatmap): Class of each point or pixel; 255 for void.
 *   depth (Heatmap): Range in metres, `[rows, columns]`, 0 where there is no point; empty unless `projected`.
 */
static inline opendr_status opendr_load_efficient_lps(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("efficient_lps", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_efficient_lps(const opendr_learner *learner,
    const opendr_point_cloud *point_cloud,
    opendr_heatmap **instance,
    opendr_heatmap **semantic,
    opendr_heatmap **depth) {
    opendr_input inputs_[1];
    opendr_output outputs_[3];
    opendr_status status_;
    inputs_[0].name = "point_cloud";
    inputs_[0].value = (const opendr_value *)point_cloud;
    outputs_[0].name = "instance";
    outputs_[0].value = NULL;
    outputs_[1].name = "semantic";
    outputs_[1].value = NULL;
    outputs_[2].name = "depth";
    outputs_[2].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 3);
    if (instance != NULL) *instance = (opendr_heatmap *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    if (semantic != NULL) *semantic = (opendr_heatmap *)outputs_[1].value;
    else opendr_value_free(&outputs_[1].value);
    if (depth != NULL) *depth = (opendr_heatmap *)outputs_[2].value;
    else opendr_value_free(&outputs_[2].value);
    return status_;
}

/*
 * SemiGlobalMatchingLearner: Computes disparity, depth and obstacles of a stereo pair by semi-global matching.
 *
 * Parameters:
 *   min_disparity (an int 0..=4096 px, live, default 0): Minimum disparity.
 *   num_disparities (an int 1..=1024 px, live, default 64): Number of disparities; rounded up to a multiple of 16.
 *   p1 (an int 0..=193, live, default 8): Penalty of a disparity change of one pixel, in differing bits of the 62-bit census.
 *   p2 (an int 0..=193, live, default 40): Penalty of a larger disparity change.
 *   uniqueness_ratio (an int 0..=99 %, live, default 5): Margin by which the best disparity must be better than the second best.
 *   disp12_max_diff (an int -1..=1000 px, live, default 1): Maximum difference in the left-right check; -1 for no check.
 *   speckle_window_size (an int 0..=1000000 px, live, default 100): Maximum size of speckles, which are removed.
 *   speckle_range (a float 0..=1000 px, live, default 1): Maximum disparity difference between neighbours of one speckle.
 *   fill (a bool, live, default false): Whether holes are filled from the background in their row.
 *   shrink (an int 1..=16 px, live, default 1): Factor by which the images are downscaled for matching: faster, coarser.
 *   focal_length (a float 0..=1000000 px, live, default 0): Focal length of the rectified pair. Required for depths.
 *   baseline (a float 0..=1000 m, live, default 0): Distance between the cameras. Required for depths.
 *   disparity_offset (a float -10000..=10000 px, live, default 0): Difference of the principal points' x, right minus left (Middlebury's doffs).
 *   camera_height (a float 0..=100 m, live, default 0): Height of the cameras above the floor. Required for obstacles.
 *   camera_pitch (a float -89..=89 deg, live, default 0): Pitch of the cameras, positive downwards.
 *   min_height (a float 0..=100 m, live, default 0.2): Minimum height of an obstacle above the floor.
 *   max_height (a float 0..=100 m, live, default 2): Maximum height of an obstacle above the floor.
 *   max_distance (a float 0.1..=100 m, live, default 10): Maximum distance of an obstacle.
 *
 * Inputs:
 *   left (Image): Image of the left camera.
 *   right (Image): Image of the right camera.
 *
 * Outputs:
 *   disparity (Heatmap): Disparity of each pixel of the left image in pixels; 0 where it is unknown.
 *   depth (Heatmap): Depth of each pixel in metres; 0 where it is unknown. Empty without focal length and baseline.
 *   obstacles (BoundingBox3DList): Obstacles on the floor, nearest first, in the frame of a level camera at the same position. Empty without focal length, baseline and camera height.
 */
static inline opendr_status opendr_load_semi_global_matching(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("semi_global_matching", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_semi_global_matching(const opendr_learner *learner,
    const opendr_image *left,
    const opendr_image *right,
    opendr_heatmap **disparity,
    opendr_heatmap **depth,
    opendr_bounding_box_3d_list **obstacles) {
    opendr_input inputs_[2];
    opendr_output outputs_[3];
    opendr_status status_;
    inputs_[0].name = "left";
    inputs_[0].value = (const opendr_value *)left;
    inputs_[1].name = "right";
    inputs_[1].value = (const opendr_value *)right;
    outputs_[0].name = "disparity";
    outputs_[0].value = NULL;
    outputs_[1].name = "depth";
    outputs_[1].value = NULL;
    outputs_[2].name = "obstacles";
    outputs_[2].value = NULL;
    status_ = opendr_infer(learner, inputs_, 2, outputs_, 3);
    if (disparity != NULL) *disparity = (opendr_heatmap *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    if (depth != NULL) *depth = (opendr_heatmap *)outputs_[1].value;
    else opendr_value_free(&outputs_[1].value);
    if (obstacles != NULL) *obstacles = (opendr_bounding_box_3d_list *)outputs_[2].value;
    else opendr_value_free(&outputs_[2].value);
    return status_;
}

/*
 * VisualOdometryLearner: Estimates the motion of a camera (single, stereo, RGB-D) with loop closure.
 *
 * Parameters:
 *   focal_length (a float 0..=1000000 px, default 0): Focal length of the camera. Required.
 *   focal_length_y (a float 0..=1000000 px, default 0): Focal length in y; 0 for that in x.
 *   principal_point_x (a float -1..=1000000 px, default -1): x of the principal point; -1 for the centre of the image.
 *   principal_point_y (a float -1..=1000000 px, default -1): y of the principal point; -1 for the centre of the image.
 *   baseline (a float 0..=1000 m, default 0): Distance between the cameras of a stereo pair; required with `right`. That of the emitter of a depth camera; 0 for 0.075.
 *   loop_interval (an int 0..=1000000, default 10): Number of key frames after which places are recognised and loops are closed, which moves the pose; 0 for never.
 *   cell (an int 12..=256 px, default 32): Side of the cells that the image is divided into; one corner is followed in each.
 *   max_corners (an int 30..=2000, default 250): Largest number of corners that are followed.
 *   threshold (a float 0.2..=20 px, default 1.5): Largest reprojection error of an inlier.
 *   min_inliers (an int 6..=1000, default 15): Smallest number of inliers; with fewer, tracking is lost.
 *   window (an int 3..=8, default 6): Number of key frames that are refined together.
 *   key_frame_motion (a float 1..=500 px, default 22): Median motion of the corners since the last key frame that makes a frame a key frame.
 *   max_disparity (an int 8..=1024 px, default 128): Largest disparity of a stereo pair.
 *   camera_height (a float 0..=100 m, default 0): Height of a single camera above the ground, from which the scale follows; 0 if unknown. The camera must look level.
 *   loop_gap (an int 5..=100000, default 30): Number of key frames between two views of a place that close a loop.
 *   loop_inliers (an int 10..=1000, default 25): Smallest number of inliers of a recognised place.
 *   tracking_threads (an int 1..=8, default 1): Number of threads that follow corners; it changes no result.
 *
 * Inputs:
 *   image (Image): Image of the camera, without distortion; the left one of a rectified stereo pair.
 *   right (Image): Image of the right camera of the pair. Optional: may be NULL.
 *   depth (Image): Depth of each pixel along the optical axis: `f32` in metres or `u16` in millimetres; 0 where it is unknown. Optional: may be NULL.
 *
 * Outputs:
 *   odometry (Odometry)
 */
static inline opendr_status opendr_load_visual_odometry(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("visual_odometry", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_visual_odometry(const opendr_learner *learner,
    const opendr_image *image,
    const opendr_image *right,
    const opendr_image *depth,
    opendr_odometry **odometry) {
    opendr_input inputs_[3];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    inputs_[1].name = "right";
    inputs_[1].value = (const opendr_value *)right;
    inputs_[2].name = "depth";
    inputs_[2].value = (const opendr_value *)depth;
    outputs_[0].name = "odometry";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 3, outputs_, 1);
    if (odometry != NULL) *odometry = (opendr_odometry *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * ImportedDepthEstimatorLearner: Runs your own depth estimator, exported to ONNX by another tool; recognises input and quantity.
 *
 * Parameters:
 *   full_size (a bool, live, default true): Whether the map has the size of the image, to which it is interpolated; else it has that of the network's output.
 *   kind (a str, one of auto, inverse_relative, relative, metric, default auto): Quantity in the output.
 *   scale (a float 0.000001..=1000000 m, default 1): Metres per unit of the output of a metric network: 0.001 for millimetres, the largest depth for fractions of it, the focal length of the network's input divided by 1000 pixels for Metric3D.
 *   interpolation (a str, one of auto, bicubic, bilinear_corners, default auto): How the map is interpolated to the size of the image.
 *   keep_aspect (a bool, default true): Whether an input of dynamic size has the aspect ratio of the image, scaled as little as possible until one side is `size`; else it is a square.
 *   multiple (an int 1..=256 px, default none): Number of which the sides of an input of dynamic size are multiples; recognised from the network if absent.
 *   depth_output (a str, default none): Name of the output; recognised from the network if absent.
 *   resize (a str, one of auto, letterbox, top_left, top_left_truncated, stretch, default auto): How an image becomes the network's input.
 *   padding (an int 0..=255, default none): Level of the padding of a letterbox; recognised from the network if absent.
 *   colour (a str, one of auto, rgb, bgr, default auto): Order of the colour channels of the network's input.
 *   levels (a str, one of auto, 0_255, 0_1, -1_1, imagenet, clip, default auto): Range of the samples of the network's input.
 *   size (an int 32..=4096 px, default none): Side of the network's input, for models of dynamic size; if absent that of its convention, 640 for most.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   heatmap (Heatmap)
 */
static inline opendr_status opendr_load_depth_estimator(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("depth_estimator", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_depth_estimator(const opendr_learner *learner,
    const opendr_image *image,
    opendr_heatmap **heatmap) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "heatmap";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (heatmap != NULL) *heatmap = (opendr_heatmap *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * PpOcrLearner: PP-OCR detects lines of text in an image and reads them; tiny and fast.
 *
 * Parameters:
 *   threshold (a float 0..=1, live, default 0.5): Score of the text below which regions are dropped.
 *   map_threshold (a float 0..=1, live, default 0.3): Probability of text above which pixels belong to a region.
 *   region_threshold (a float 0..=1, live, default 0.6): Mean probability of text below which regions are not read.
 *   unclip_ratio (a float 0..=5, live, default 1.5): Growth of regions, which the detector learned shrunken: area / perimeter times this on each side.
 *   max_side (an int 32..=8192 px, live, default 960): Maximum side of the detector's input. A larger image is scaled down to it; smaller text is found with a larger one.
 *   turn (a bool, live, default true): Whether lines that are upside down are turned, if the model has a classifier of the orientation.
 *   read_twice (a bool, live, default true): Whether each line is read a second time, with a margin: spaces between words are recognised there that the first reading misses (38 and 58 of 60 rendered lines without an error), but distant letters less well.
 *   max_regions (an int 1..=1000, live, default 1000): Maximum number of regions per image that are read.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   texts (TextRegionList)
 */
static inline opendr_status opendr_load_pp_ocr(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("pp_ocr", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_pp_ocr(const opendr_learner *learner,
    const opendr_image *image,
    opendr_text_region_list **texts) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "texts";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (texts != NULL) *texts = (opendr_text_region_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * AmbiguityMeasureLearner: Measures whether the highest peak of a map of values is ambiguous.
 *
 * Parameters:
 *   threshold (a float 0..=0.999999, live, default 0.5): Minimum probability of all peaks except the best one at which a map is ambiguous.
 *   temperature (a float 0.000001..=1000000, live, default 1): Temperature of the softmax; a higher one makes maps more ambiguous.
 *
 * Inputs:
 *   heatmap (Heatmap)
 *
 * Outputs:
 *   category (Category): Class 1 if the map is ambiguous, else 0; the probabilities are those of the best peak and of all others.
 *   peaks (Heatmap): Peaks `[peaks, 4]`: row, column, value and probability, sorted by persistence.
 */
static inline opendr_status opendr_load_ambiguity_measure(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("ambiguity_measure", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_ambiguity_measure(const opendr_learner *learner,
    const opendr_heatmap *heatmap,
    opendr_category **category,
    opendr_heatmap **peaks) {
    opendr_input inputs_[1];
    opendr_output outputs_[2];
    opendr_status status_;
    inputs_[0].name = "heatmap";
    inputs_[0].value = (const opendr_value *)heatmap;
    outputs_[0].name = "category";
    outputs_[0].value = NULL;
    outputs_[1].name = "peaks";
    outputs_[1].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 2);
    if (category != NULL) *category = (opendr_category *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    if (peaks != NULL) *peaks = (opendr_heatmap *)outputs_[1].value;
    else opendr_value_free(&outputs_[1].value);
    return status_;
}

/*
 * GrConvNetLearner: GR-ConvNet detects grasps of a parallel-jaw gripper in colour and depth.
 *
 * Parameters:
 *   threshold (a float 0..=1, live, default 0.2): Minimum quality of a grasp.
 *   max_grasps (an int 1..=100, live, default 5): Maximum number of grasps per image.
 *   distance (an int 1..=224 px, live, default 20): Minimum distance between two grasps, in pixels of the network's map of 224.
 *
 * Inputs:
 *   image (Image): The colour image.
 *   depth (Image): Depth of the same view and size: one channel, 16 bits in millimetres or floats in metres; 0 for unknown.
 *
 * Outputs:
 *   poses (PoseList)
 */
static inline opendr_status opendr_load_gr_conv_net(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("gr_conv_net", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_gr_conv_net(const opendr_learner *learner,
    const opendr_image *image,
    const opendr_image *depth,
    opendr_pose_list **poses) {
    opendr_input inputs_[2];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    inputs_[1].name = "depth";
    inputs_[1].value = (const opendr_value *)depth;
    outputs_[0].name = "poses";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 2, outputs_, 1);
    if (poses != NULL) *poses = (opendr_pose_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * SpatioTemporalGCNLearner: ST-GCN, TA-GCN or ST-BLN classifies the action in a clip of a moving skeleton; trainable.
 *
 * Parameters:
 *   num_class (an int 2..=10000, default none): Number of classes. None: the number of classes in the data set.
 *   num_point (an int 2..=1000, default none): Number of joints. None: that of the graph.
 *   num_person (an int 1..=64, default 2): Maximum number of persons, the first ones of a recording; the prediction is the mean over those present.
 *   in_channels (an int 2..=3, default 3): Number of coordinates of a joint: 2 (a third channel of the input holds scores) or 3.
 *   graph_type (a str, one of ntu, kinetics, coco, jhmdb, kinect, default ntu): Skeleton: joints and bones.
 *   num_frames (an int 1..=10000, default 300): Number of frames of a clip: the last ones of a longer recording; a shorter one is preceded by its repeated first frame.
 *   temporal_kernel (an int 3..=101, default 9): Kernel size in time of each block; odd.
 *   method_name (a str, one of stgcn, tagcn, stbln, default stgcn): Network architecture.
 *   stbln_symmetric (a bool, default false): Whether the matrices of `stbln` are symmetric.
 *   num_subframes (an int 1..=10000, default 100): Number of frames that `tagcn` selects.
 *   channels (a list 1..=4096, default none): Output channels of each block; the first two of `tagcn` do not convolve through time. None: 64, 64, 64, 64, 128, 128, 128, 256, 256, 256; for `tagcn` 64, 64, 128, 128, 256, 256.
 *
 * Inputs:
 *   skeleton_sequence (SkeletonSequence)
 *
 * Outputs:
 *   category (Category)
 */
static inline opendr_status opendr_load_spatio_temporal_gcn(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("spatio_temporal_gcn", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_spatio_temporal_gcn(const opendr_learner *learner,
    const opendr_skeleton_sequence *skeleton_sequence,
    opendr_category **category) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "skeleton_sequence";
    inputs_[0].value = (const opendr_value *)skeleton_sequence;
    outputs_[0].name = "category";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (category != NULL) *category = (opendr_category *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * ProgressiveSpatioTemporalGCNLearner: PST-GCN classifies the action in a clip of a moving skeleton; its network grows in the training.
 *
 * Parameters:
 *   num_class (an int 2..=10000, default none): Number of classes. None: the number of classes in the data set.
 *   num_point (an int 2..=1000, default none): Number of joints. None: that of the graph.
 *   num_person (an int 1..=64, default 2): Maximum number of persons, the first ones of a recording; the prediction is the mean over those present.
 *   in_channels (an int 2..=3, default 3): Number of coordinates of a joint: 2 (a third channel of the input holds scores) or 3.
 *   graph_type (a str, one of ntu, kinetics, coco, jhmdb, kinect, default ntu): Skeleton: joints and bones.
 *   num_frames (an int 1..=10000, default 300): Number of frames of a clip: the last ones of a longer recording; a shorter one is preceded by its repeated first frame.
 *   temporal_kernel (an int 3..=101, default 9): Kernel size in time of each block; odd.
 *   blocksize (an int 1..=256, default 20): Output channels of a block.
 *   num_blocks (an int 1..=1000, default 10): Maximum number of blocks of a layer of a network that grows.
 *   num_layers (an int 1..=100, default 10): Maximum number of layers of a network that grows.
 *   topology (a list 1..=1000, default ): Number of blocks of each layer. Empty: `fit` finds it; the network grows while its training loss decreases.
 *   layer_threshold (a float 0..=1, default 0.0001): Relative decrease of the training loss that a further layer must exceed.
 *   block_threshold (a float 0..=1, default 0.0001): Relative decrease of the training loss that a further block must exceed.
 *
 * Inputs:
 *   skeleton_sequence (SkeletonSequence)
 *
 * Outputs:
 *   category (Category)
 */
static inline opendr_status opendr_load_progressive_spatio_temporal_gcn(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("progressive_spatio_temporal_gcn", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_progressive_spatio_temporal_gcn(const opendr_learner *learner,
    const opendr_skeleton_sequence *skeleton_sequence,
    opendr_category **category) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "skeleton_sequence";
    inputs_[0].value = (const opendr_value *)skeleton_sequence;
    outputs_[0].name = "category";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (category != NULL) *category = (opendr_category *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * CoSTGCNLearner: CoST-GCN, CoA-GCN or CoS-TR classifies the action of a moving skeleton, updated with every frame; trainable.
 *
 * Parameters:
 *   num_classes (an int 2..=10000, default none): Number of classes. None: the number of classes in the data set.
 *   num_point (an int 2..=1000, default none): Number of joints. None: that of the graph.
 *   num_person (an int 1..=64, default 2): Maximum number of persons, the first ones of a recording; the prediction is the mean over those present so far.
 *   in_channels (an int 2..=3, default 3): Number of coordinates of a joint: 2 (a third channel of the input holds scores) or 3.
 *   graph_type (a str, one of ntu, kinetics, coco, jhmdb, kinect, default ntu): Skeleton: joints and bones.
 *   backbone (a str, one of costgcn, coagcn, costr, default costgcn): Network architecture.
 *   sequence_len (an int 1..=10000, default 300): Number of frames that a prediction covers.
 *   channels (a list 1..=4096, default 64,64,64,64,128,128,128,256,256,256): Output channels of each block; in `costr`, multiples of 32 from the fourth block on.
 *   temporal_kernel (an int 3..=101, default 9): Kernel size in time of each block; odd.
 *
 * Inputs:
 *   skeleton_sequence (SkeletonSequence)
 *
 * Outputs:
 *   category (Category)
 */
static inline opendr_status opendr_load_co_st_gcn(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("co_st_gcn", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_co_st_gcn(const opendr_learner *learner,
    const opendr_skeleton_sequence *skeleton_sequence,
    opendr_category **category) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "skeleton_sequence";
    inputs_[0].value = (const opendr_value *)skeleton_sequence;
    outputs_[0].name = "category";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (category != NULL) *category = (opendr_category *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * X3DLearner: X3D classifies the activity in a video clip; trainable.
 *
 * Parameters:
 *   backbone (a str, one of s, xs, m, l, default s): Default frames of a clip, side of a frame and depth of the network.
 *   num_classes (an int 2..=10000, default none): Number of classes. None: the number of classes in the data set.
 *   num_frames (an int 1..=256, default none): Number of frames of a clip, sampled evenly. None: that of the backbone.
 *   side (an int 32..=1024 px, default none): Side of a frame in pixels. None: that of the backbone.
 *   width (a float 0.1..=8, default 1): Factor on the number of channels.
 *   depth (a float 0.1..=8, default none): Factor on the number of blocks. None: that of the backbone.
 *
 * Inputs:
 *   video (Video)
 *
 * Outputs:
 *   category (Category)
 */
static inline opendr_status opendr_load_x3d(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("x3d", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_x3d(const opendr_learner *learner,
    const opendr_video *video,
    opendr_category **category) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "video";
    inputs_[0].value = (const opendr_value *)video;
    outputs_[0].name = "category";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (category != NULL) *category = (opendr_category *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * CoX3DLearner: CoX3D classifies the activity in a video, updated with every frame; trainable.
 *
 * Parameters:
 *   backbone (a str, one of s, xs, m, l, default s): Default frames of a clip, side of a frame and depth of the network.
 *   num_classes (an int 2..=10000, default none): Number of classes. None: the number of classes in the data set.
 *   temporal_window_size (an int 1..=256, default none): Number of frames over which the features are averaged. None: that of the backbone.
 *   side (an int 32..=1024 px, default none): Side of a frame in pixels. None: that of the backbone.
 *   width (a float 0.1..=8, default 1): Factor on the number of channels.
 *   depth (a float 0.1..=8, default none): Factor on the number of blocks. None: that of the backbone.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   category (Category)
 */
static inline opendr_status opendr_load_co_x3d(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("co_x3d", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_co_x3d(const opendr_learner *learner,
    const opendr_image *image,
    opendr_category **category) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "category";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (category != NULL) *category = (opendr_category *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * AudiovisualEmotionLearner: Recognises the emotion of a person from voice and face; trainable.
 *
 * Parameters:
 *   num_class (an int 2..=10000, default none): Number of classes. None: the number of classes in the data set.
 *   seq_length (an int 2..=256, default 15): Number of frames of the face, sampled evenly from the video.
 *   fusion (a str, one of ia, it, lt, default ia): Fusion of the two branches.
 *   sample_rate (an int 8000..=48000 Hz, default 22050): Sample rate of the audio.
 *   seconds (a float 0.2..=60 s, default 3.6): Duration of the audio that is used, from its start; shorter audio is padded.
 *
 * Inputs:
 *   audio (Audio): The voice, at the learner's sample rate.
 *   video (Video): The cropped face, `[3, frames, height, width]`. Optional: may be NULL.
 *
 * Outputs:
 *   category (Category)
 */
static inline opendr_status opendr_load_audiovisual_emotion(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("audiovisual_emotion", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_audiovisual_emotion(const opendr_learner *learner,
    const opendr_audio *audio,
    const opendr_video *video,
    opendr_category **category) {
    opendr_input inputs_[2];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "audio";
    inputs_[0].value = (const opendr_value *)audio;
    inputs_[1].name = "video";
    inputs_[1].value = (const opendr_value *)video;
    outputs_[0].name = "category";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 2, outputs_, 1);
    if (category != NULL) *category = (opendr_category *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * RgbdHandGestureLearner: Recognises hand gestures from colour and depth; trainable.
 *
 * Parameters:
 *   n_class (an int 2..=10000, default none): Number of classes. None: the number of classes in the data set.
 *   architecture (a str, one of small, default small): Network architecture.
 *
 * Inputs:
 *   image (Image): The colour image.
 *   depth (Image): Depth of the same view, one channel: floats in metres, 16 bits in millimetres, 8 bits in centimetres. Values of at most 0 are unknown.
 *
 * Outputs:
 *   category (Category)
 */
static inline opendr_status opendr_load_rgbd_hand_gesture(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("rgbd_hand_gesture", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_rgbd_hand_gesture(const opendr_learner *learner,
    const opendr_image *image,
    const opendr_image *depth,
    opendr_category **category) {
    opendr_input inputs_[2];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    inputs_[1].name = "depth";
    inputs_[1].value = (const opendr_value *)depth;
    outputs_[0].name = "category";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 2, outputs_, 1);
    if (category != NULL) *category = (opendr_category *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * GatedRecurrentUnitLearner: A gated recurrent unit classifies heart beats as normal or abnormal.
 *
 * Parameters:
 *   in_channels (an int 1..=1024, default none): Number of features of a series (leads of a recording). None: that of the data set.
 *   series_length (an int 1..=1000000, default none): Number of time steps of a series. None: that of the data set.
 *   n_class (an int 2..=10000, default none): Number of classes. None: the number of classes in the data set.
 *   dropout (a float 0..=0.99, default 0.2): Dropout probability.
 *   sample_rate (a float 50..=10000 Hz, default none): Sample rate of a stream, in which beats are detected. None: each piece of a stream is a whole series.
 *   recurrent_unit (an int 1..=4096, default 512): Number of features of the recurrent unit's state.
 *
 * Inputs:
 *   timeseries (Timeseries)
 *
 * Outputs:
 *   category (Category)
 */
static inline opendr_status opendr_load_gated_recurrent_unit(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("gated_recurrent_unit", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_gated_recurrent_unit(const opendr_learner *learner,
    const opendr_timeseries *timeseries,
    opendr_category **category) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "timeseries";
    inputs_[0].value = (const opendr_value *)timeseries;
    outputs_[0].name = "category";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (category != NULL) *category = (opendr_category *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * AttentionNeuralBagOfFeatureLearner: A neural bag of features with attention classifies heart beats as normal or abnormal.
 *
 * Parameters:
 *   in_channels (an int 1..=1024, default none): Number of features of a series (leads of a recording). None: that of the data set.
 *   series_length (an int 1..=1000000, default none): Number of time steps of a series. None: that of the data set.
 *   n_class (an int 2..=10000, default none): Number of classes. None: the number of classes in the data set.
 *   dropout (a float 0..=0.99, default 0.2): Dropout probability.
 *   sample_rate (a float 50..=10000 Hz, default none): Sample rate of a stream, in which beats are detected. None: each piece of a stream is a whole series.
 *   n_codeword (an int 1..=4096, default 256): Number of codewords.
 *   quantization_type (a str, one of nbof, tnbof, default nbof): Input of the bag of features.
 *   attention_type (a str, one of spatial, temporal, spatialsa, temporalsa, spatiotemporal, default spatial): Axis and kind of the attention.
 *
 * Inputs:
 *   timeseries (Timeseries)
 *
 * Outputs:
 *   category (Category)
 */
static inline opendr_status opendr_load_attention_neural_bag_of_feature(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("attention_neural_bag_of_feature", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_attention_neural_bag_of_feature(const opendr_learner *learner,
    const opendr_timeseries *timeseries,
    opendr_category **category) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "timeseries";
    inputs_[0].value = (const opendr_value *)timeseries;
    outputs_[0].name = "category";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (category != NULL) *category = (opendr_category *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * CoTransEncLearner: A continual transformer encoder classifies a stream of feature vectors, updated with every vector; trainable.
 *
 * Parameters:
 *   num_layers (an int 1..=2, default 1): Number of encoder layers.
 *   input_dims (an int 1..=65536, default none): Number of features of an input vector. None: that of the data set.
 *   token_dims (an int 1..=65536, default none): Number of features of a token, to which input vectors are projected; a multiple of `num_heads`. None: input vectors are tokens, without a projection.
 *   hidden_dims (an int 1..=65536, default 1024): Number of features between the two linear maps of a layer.
 *   sequence_len (an int 2..=100000, default 64): Number of vectors that a prediction covers.
 *   num_heads (an int 1..=1024, default 8): Number of attention heads.
 *   num_classes (an int 2..=10000, default none): Number of classes. None: the number of classes in the data set.
 *   positional_encoding_learned (a bool, default false): Whether the positional encoding is learnt; otherwise it consists of sines and cosines.
 *
 * Inputs:
 *   timeseries (Timeseries)
 *
 * Outputs:
 *   category (Category)
 */
static inline opendr_status opendr_load_co_trans_enc(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("co_trans_enc", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_co_trans_enc(const opendr_learner *learner,
    const opendr_timeseries *timeseries,
    opendr_category **category) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "timeseries";
    inputs_[0].value = (const opendr_value *)timeseries;
    outputs_[0].name = "category";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (category != NULL) *category = (opendr_category *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * EdgeSpeechNetsLearner: EdgeSpeechNets classify spoken words; four sizes.
 *
 * Parameters:
 *   architecture (a str, one of A, B, C, D, default A): Network that is trained; a loaded model has its own.
 *   output_classes_n (an int 2..=10000, default none): Number of classes. None: the number of classes in the data set (OpenDR's default is 20).
 *   preprocess_to_mfcc (a bool, default true): Whether cepstra are computed from the input. Unset, the input is a Timeseries of cepstra with the network's number of coefficients.
 *   sample_rate (an int 4000..=384000 Hz, default 16000): Sample rate of the audio.
 *   voice_activity (a str, default none): Path of a container of `silero_vad`; seconds of a stream without speech then yield no prediction (wake-word mode). None: every second yields a prediction.
 *
 * Inputs:
 *   audio (Audio): Audio; a Timeseries of one feature has the learner's sample rate.
 *
 * Outputs:
 *   category (Category)
 */
static inline opendr_status opendr_load_edge_speech_nets(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("edge_speech_nets", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_edge_speech_nets(const opendr_learner *learner,
    const opendr_audio *audio,
    opendr_category **category) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "audio";
    inputs_[0].value = (const opendr_value *)audio;
    outputs_[0].name = "category";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (category != NULL) *category = (opendr_category *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * QuadraticSelfOnnLearner: A Self-ONN of two layers of quadratic neurons classifies spoken words.
 *
 * Parameters:
 *   expansion_order (an int 1..=9, default 3): Highest power of the input in a neuron of the network that is trained; a loaded model has its own.
 *   output_classes_n (an int 2..=10000, default none): Number of classes. None: the number of classes in the data set (OpenDR's default is 20).
 *   preprocess_to_mfcc (a bool, default true): Whether cepstra are computed from the input. Unset, the input is a Timeseries of cepstra with the network's number of coefficients.
 *   sample_rate (an int 4000..=384000 Hz, default 16000): Sample rate of the audio.
 *   voice_activity (a str, default none): Path of a container of `silero_vad`; seconds of a stream without speech then yield no prediction (wake-word mode). None: every second yields a prediction.
 *
 * Inputs:
 *   audio (Audio): Audio; a Timeseries of one feature has the learner's sample rate.
 *
 * Outputs:
 *   category (Category)
 */
static inline opendr_status opendr_load_quadratic_self_onn(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("quadratic_self_onn", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_quadratic_self_onn(const opendr_learner *learner,
    const opendr_audio *audio,
    opendr_category **category) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "audio";
    inputs_[0].value = (const opendr_value *)audio;
    outputs_[0].name = "category";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (category != NULL) *category = (opendr_category *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * MatchboxNetLearner: MatchboxNet classifies spoken words; small and fast.
 *
 * Parameters:
 *   number_of_blocks (an int 1..=64, default 3): Number of residual blocks (B in the paper).
 *   number_of_subblocks (an int 1..=64, default 1): Number of convolutions per block (R in the paper).
 *   number_of_channels (an int 1..=4096, default 64): Number of channels of the blocks (C in the paper).
 *   output_classes_n (an int 2..=10000, default none): Number of classes. None: the number of classes in the data set (OpenDR's default is 20).
 *   preprocess_to_mfcc (a bool, default true): Whether cepstra are computed from the input. Unset, the input is a Timeseries of cepstra with the network's number of coefficients.
 *   sample_rate (an int 4000..=384000 Hz, default 16000): Sample rate of the audio.
 *   voice_activity (a str, default none): Path of a container of `silero_vad`; seconds of a stream without speech then yield no prediction (wake-word mode). None: every second yields a prediction.
 *
 * Inputs:
 *   audio (Audio): Audio; a Timeseries of one feature has the learner's sample rate.
 *
 * Outputs:
 *   category (Category)
 */
static inline opendr_status opendr_load_matchboxnet(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("matchboxnet", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_matchboxnet(const opendr_learner *learner,
    const opendr_audio *audio,
    opendr_category **category) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "audio";
    inputs_[0].value = (const opendr_value *)audio;
    outputs_[0].name = "category";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (category != NULL) *category = (opendr_category *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * DsCnnLearner: DS-CNN classifies twelve spoken words, in 52 kB and INT8.
 *
 * Parameters:
 *   voice_activity (a str, default none): Path of a container of `silero_vad`; seconds of a stream without speech then yield no prediction (wake-word mode). None: every second yields a prediction.
 *
 * Inputs:
 *   audio (Audio): Audio; a Timeseries of one feature has the learner's sample rate.
 *
 * Outputs:
 *   category (Category)
 */
static inline opendr_status opendr_load_ds_cnn(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("ds_cnn", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_ds_cnn(const opendr_learner *learner,
    const opendr_audio *audio,
    opendr_category **category) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "audio";
    inputs_[0].value = (const opendr_value *)audio;
    outputs_[0].name = "category";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (category != NULL) *category = (opendr_category *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * SileroVadLearner: Silero VAD detects speech in chunks of 32 ms.
 *
 * Parameters:
 *   threshold (a float 0..=1, live, default 0.5): Minimum probability at which speech starts; it ends 0.15 below.
 *   min_silence_duration_ms (an int 0..=60000 ms, live, default 100): Duration of silence that ends speech.
 *
 * Inputs:
 *   audio (Audio): Audio; a Timeseries of one feature has the learner's sample rate.
 *
 * Outputs:
 *   category (Category)
 */
static inline opendr_status opendr_load_silero_vad(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("silero_vad", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_silero_vad(const opendr_learner *learner,
    const opendr_audio *audio,
    opendr_category **category) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "audio";
    inputs_[0].value = (const opendr_value *)audio;
    outputs_[0].name = "category";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (category != NULL) *category = (opendr_category *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * WhisperLearner: Whisper transcribes speech, with timestamps.
 *
 * Parameters:
 *   temperature (a list 0..=10, live, default 0,0.2,0.4,0.6,0.8,1): Sampling temperatures; the next one is used where the text at the previous one is repetitive or unlikely. 0 selects the likeliest token.
 *   compression_ratio_threshold (a float 0..=1000, live, default 2.4): Compression ratio above which a text counts as repetitive. None: no limit.
 *   logprob_threshold (a float -1000..=0, live, default -0.8): Mean log-probability of the tokens below which a text counts as unlikely. None: no limit.
 *   no_speech_threshold (a float 0..=1, live, default 0.6): Probability of no speech above which a window with an unlikely text counts as silent. None: no window does.
 *   condition_on_previous_text (a bool, live, default false): Whether the text of a window is the prompt of the next: more coherent, but errors can propagate.
 *   language (a str, live, default en): Language of the speech, e.g. `en`. None: multilingual models detect it in the first 30 s.
 *   sample_len (an int 1..=448, live, default none): Maximum number of tokens per window. None: 224.
 *   best_of (an int 1..=64, live, default none): Number of samples at each temperature above 0, of which the likeliest is selected. None: one.
 *   beam_size (an int 1..=64, live, default none): Beam size at temperature 0. None: greedy decoding.
 *   patience (a float 0..=64, live, default none): Factor on the number of finished texts that ends a beam search. None: 1.
 *   length_penalty (a float 0..=1, live, default none): Exponent of the length penalty (Google's GNMT), 0 to 1. None: candidates are ranked by the mean of their tokens.
 *   initial_prompt (a str, live, default none): Prompt of the first window: names and spellings to expect.
 *   prefix (a str, live, default none): Text at the start of every window.
 *   suppress_tokens (a str, live, default -1): Token ids that are never decoded, separated by commas; -1 stands for symbols that are not spoken. None: no token is suppressed.
 *   suppress_blank (a bool, live, default true): Whether a window must not begin with a space or with its end.
 *   without_timestamps (a bool, live, default false): Whether to omit timestamps; each window is then one segment.
 *   max_initial_timestamp (a float 0..=30 s, live, default 1): Latest start of a window's first segment. None: no limit.
 *   partial_interval (a float 0.5..=30 s, live, default 3): Interval of partial transcriptions of an unfinished phrase in a stream. None: finished phrases only.
 *   silence_level (a float 0..=1, live, default 0.002): Root mean square below which audio in a stream is silence.
 *
 * Inputs:
 *   audio (Audio): Audio; a Timeseries of one feature has the learner's sample rate.
 *
 * Outputs:
 *   transcription (WhisperTranscription)
 */
static inline opendr_status opendr_load_whisper(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("whisper", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_whisper(const opendr_learner *learner,
    const opendr_audio *audio,
    opendr_whisper_transcription **transcription) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "audio";
    inputs_[0].value = (const opendr_value *)audio;
    outputs_[0].name = "transcription";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (transcription != NULL) *transcription = (opendr_whisper_transcription *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * PpoLearner: Proximal policy optimisation: a robust first choice, for discrete and continuous actions.
 *
 * Parameters:
 *   deterministic (a bool, live, default true): Whether the policy takes its most likely actions instead of sampling.
 *   seed (an int, default 0): Seed of sampled actions, at the start of a stream.
 *   shield (a str, default none): Name of the safety rule that decides which actions are replaced (`opendr sim priors` lists the rules); none disables the shield.
 *   shield_prior (a str, default none): Name of the prior that acts instead, in its newest version; none means the policy's own prior.
 *
 * Inputs:
 *   observation (Observation)
 *
 * Outputs:
 *   target (RlTarget)
 */
static inline opendr_status opendr_load_ppo(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("ppo", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_ppo(const opendr_learner *learner,
    const opendr_observation *observation,
    opendr_rl_target **target) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "observation";
    inputs_[0].value = (const opendr_value *)observation;
    outputs_[0].name = "target";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (target != NULL) *target = (opendr_rl_target *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * SacLearner: Soft actor-critic: sample-efficient, for continuous actions and environments with expensive steps.
 *
 * Parameters:
 *   deterministic (a bool, live, default true): Whether the policy takes its most likely actions instead of sampling.
 *   seed (an int, default 0): Seed of sampled actions, at the start of a stream.
 *   shield (a str, default none): Name of the safety rule that decides which actions are replaced (`opendr sim priors` lists the rules); none disables the shield.
 *   shield_prior (a str, default none): Name of the prior that acts instead, in its newest version; none means the policy's own prior.
 *
 * Inputs:
 *   observation (Observation)
 *
 * Outputs:
 *   target (RlTarget)
 */
static inline opendr_status opendr_load_sac(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("sac", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_sac(const opendr_learner *learner,
    const opendr_observation *observation,
    opendr_rl_target **target) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "observation";
    inputs_[0].value = (const opendr_value *)observation;
    outputs_[0].name = "target";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (target != NULL) *target = (opendr_rl_target *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * Td3Learner: Twin delayed deep deterministic policy gradient: deterministic policies for continuous actions.
 *
 * Parameters:
 *   deterministic (a bool, live, default true): Whether the policy takes its most likely actions instead of sampling.
 *   seed (an int, default 0): Seed of sampled actions, at the start of a stream.
 *   shield (a str, default none): Name of the safety rule that decides which actions are replaced (`opendr sim priors` lists the rules); none disables the shield.
 *   shield_prior (a str, default none): Name of the prior that acts instead, in its newest version; none means the policy's own prior.
 *
 * Inputs:
 *   observation (Observation)
 *
 * Outputs:
 *   target (RlTarget)
 */
static inline opendr_status opendr_load_td3(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("td3", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_td3(const opendr_learner *learner,
    const opendr_observation *observation,
    opendr_rl_target **target) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "observation";
    inputs_[0].value = (const opendr_value *)observation;
    outputs_[0].name = "target";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (target != NULL) *target = (opendr_rl_target *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * DqnLearner: Deep Q-learning: discrete actions, trained from a replay buffer.
 *
 * Parameters:
 *   deterministic (a bool, live, default true): Whether the policy takes its most likely actions instead of sampling.
 *   seed (an int, default 0): Seed of sampled actions, at the start of a stream.
 *   shield (a str, default none): Name of the safety rule that decides which actions are replaced (`opendr sim priors` lists the rules); none disables the shield.
 *   shield_prior (a str, default none): Name of the prior that acts instead, in its newest version; none means the policy's own prior.
 *
 * Inputs:
 *   observation (Observation)
 *
 * Outputs:
 *   target (RlTarget)
 */
static inline opendr_status opendr_load_dqn(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("dqn", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_dqn(const opendr_learner *learner,
    const opendr_observation *observation,
    opendr_rl_target **target) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "observation";
    inputs_[0].value = (const opendr_value *)observation;
    outputs_[0].name = "target";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (target != NULL) *target = (opendr_rl_target *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * ResidualPpoLearner: A prior controller with corrections that PPO trains.
 *
 * Parameters:
 *   deterministic (a bool, live, default true): Whether the policy takes its most likely actions instead of sampling.
 *   seed (an int, default 0): Seed of sampled actions, at the start of a stream.
 *   shield (a str, default none): Name of the safety rule that decides which actions are replaced (`opendr sim priors` lists the rules); none disables the shield.
 *   shield_prior (a str, default none): Name of the prior that acts instead, in its newest version; none means the policy's own prior.
 *
 * Inputs:
 *   observation (Observation)
 *
 * Outputs:
 *   target (RlTarget)
 */
static inline opendr_status opendr_load_residual_ppo(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("residual_ppo", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_residual_ppo(const opendr_learner *learner,
    const opendr_observation *observation,
    opendr_rl_target **target) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "observation";
    inputs_[0].value = (const opendr_value *)observation;
    outputs_[0].name = "target";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (target != NULL) *target = (opendr_rl_target *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * ResidualSacLearner: A prior controller with corrections that SAC trains.
 *
 * Parameters:
 *   deterministic (a bool, live, default true): Whether the policy takes its most likely actions instead of sampling.
 *   seed (an int, default 0): Seed of sampled actions, at the start of a stream.
 *   shield (a str, default none): Name of the safety rule that decides which actions are replaced (`opendr sim priors` lists the rules); none disables the shield.
 *   shield_prior (a str, default none): Name of the prior that acts instead, in its newest version; none means the policy's own prior.
 *
 * Inputs:
 *   observation (Observation)
 *
 * Outputs:
 *   target (RlTarget)
 */
static inline opendr_status opendr_load_residual_sac(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("residual_sac", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_residual_sac(const opendr_learner *learner,
    const opendr_observation *observation,
    opendr_rl_target **target) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "observation";
    inputs_[0].value = (const opendr_value *)observation;
    outputs_[0].name = "target";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (target != NULL) *target = (opendr_rl_target *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * ResidualTd3Learner: A prior controller with corrections that TD3 trains.
 *
 * Parameters:
 *   deterministic (a bool, live, default true): Whether the policy takes its most likely actions instead of sampling.
 *   seed (an int, default 0): Seed of sampled actions, at the start of a stream.
 *   shield (a str, default none): Name of the safety rule that decides which actions are replaced (`opendr sim priors` lists the rules); none disables the shield.
 *   shield_prior (a str, default none): Name of the prior that acts instead, in its newest version; none means the policy's own prior.
 *
 * Inputs:
 *   observation (Observation)
 *
 * Outputs:
 *   target (RlTarget)
 */
static inline opendr_status opendr_load_residual_td3(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("residual_td3", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_residual_td3(const opendr_learner *learner,
    const opendr_observation *observation,
    opendr_rl_target **target) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "observation";
    inputs_[0].value = (const opendr_value *)observation;
    outputs_[0].name = "target";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (target != NULL) *target = (opendr_rl_target *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * ShapedPpoLearner: A prior controller that follows commands of a policy that PPO trains.
 *
 * Parameters:
 *   deterministic (a bool, live, default true): Whether the policy takes its most likely actions instead of sampling.
 *   seed (an int, default 0): Seed of sampled actions, at the start of a stream.
 *   shield (a str, default none): Name of the safety rule that decides which actions are replaced (`opendr sim priors` lists the rules); none disables the shield.
 *   shield_prior (a str, default none): Name of the prior that acts instead, in its newest version; none means the policy's own prior.
 *
 * Inputs:
 *   observation (Observation)
 *
 * Outputs:
 *   target (RlTarget)
 */
static inline opendr_status opendr_load_shaped_ppo(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("shaped_ppo", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_shaped_ppo(const opendr_learner *learner,
    const opendr_observation *observation,
    opendr_rl_target **target) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "observation";
    inputs_[0].value = (const opendr_value *)observation;
    outputs_[0].name = "target";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (target != NULL) *target = (opendr_rl_target *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * ShapedSacLearner: A prior controller that follows commands of a policy that SAC trains.
 *
 * Parameters:
 *   deterministic (a bool, live, default true): Whether the policy takes its most likely actions instead of sampling.
 *   seed (an int, default 0): Seed of sampled actions, at the start of a stream.
 *   shield (a str, default none): Name of the safety rule that decides which actions are replaced (`opendr sim priors` lists the rules); none disables the shield.
 *   shield_prior (a str, default none): Name of the prior that acts instead, in its newest version; none means the policy's own prior.
 *
 * Inputs:
 *   observation (Observation)
 *
 * Outputs:
 *   target (RlTarget)
 */
static inline opendr_status opendr_load_shaped_sac(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("shaped_sac", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_shaped_sac(const opendr_learner *learner,
    const opendr_observation *observation,
    opendr_rl_target **target) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "observation";
    inputs_[0].value = (const opendr_value *)observation;
    outputs_[0].name = "target";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (target != NULL) *target = (opendr_rl_target *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * MobileRLLearner: Mobile manipulation: moves the base so that the arm can follow a planned motion of its gripper.
 *
 * Parameters:
 *   deterministic (a bool, live, default true): Whether the policy takes its most likely actions instead of sampling.
 *   seed (an int, default 0): Seed of sampled actions, at the start of a stream.
 *   shield (a str, default none): Name of the safety rule that decides which actions are replaced (`opendr sim priors` lists the rules); none disables the shield.
 *   shield_prior (a str, default none): Name of the prior that acts instead, in its newest version; none means the policy's own prior.
 *
 * Inputs:
 *   observation (Observation)
 *
 * Outputs:
 *   target (RlTarget)
 */
static inline opendr_status opendr_load_mobile_rl(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("mobile_rl", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_mobile_rl(const opendr_learner *learner,
    const opendr_observation *observation,
    opendr_rl_target **target) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "observation";
    inputs_[0].value = (const opendr_value *)observation;
    outputs_[0].name = "target";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (target != NULL) *target = (opendr_rl_target *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * MultiObjectSearchRLLearner: Multi-object search: chooses where a robot drives next to find objects in a flat.
 *
 * Parameters:
 *   deterministic (a bool, live, default true): Whether the policy takes its most likely actions instead of sampling.
 *   seed (an int, default 0): Seed of sampled actions, at the start of a stream.
 *   shield (a str, default none): Name of the safety rule that decides which actions are replaced (`opendr sim priors` lists the rules); none disables the shield.
 *   shield_prior (a str, default none): Name of the prior that acts instead, in its newest version; none means the policy's own prior.
 *
 * Inputs:
 *   observation (Observation)
 *
 * Outputs:
 *   target (RlTarget)
 */
static inline opendr_status opendr_load_multi_object_search_rl(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("multi_object_search_rl", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_multi_object_search_rl(const opendr_learner *learner,
    const opendr_observation *observation,
    opendr_rl_target **target) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "observation";
    inputs_[0].value = (const opendr_value *)observation;
    outputs_[0].name = "target";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (target != NULL) *target = (opendr_rl_target *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * ActLearner: Action chunking with transformers: imitates demonstrations, several actions per prediction.
 *
 * Parameters:
 *   temporal_ensemble (a bool, default true): Whether each action is the weighted mean of all predictions for its step, with one prediction per step.
 *   temporal_ensemble_coeff (a float -10..=10, default 0.01): Decay of the weights of newer predictions: `exp(-coefficient i)`, where i is 0 for the oldest.
 *   n_action_steps (an int 1..=1000, default 10): Actions of a chunk that are executed before the next prediction, without temporal ensemble.
 *
 * Inputs:
 *   observation (Observation)
 *
 * Outputs:
 *   target (RlTarget)
 */
static inline opendr_status opendr_load_act(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("act", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_act(const opendr_learner *learner,
    const opendr_observation *observation,
    opendr_rl_target **target) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "observation";
    inputs_[0].value = (const opendr_value *)observation;
    outputs_[0].name = "target";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (target != NULL) *target = (opendr_rl_target *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * DiffusionPolicyLearner: Diffusion policy: imitates demonstrations that reach their goal in several ways.
 *
 * Parameters:
 *   num_inference_steps (an int 1..=1000, default 10): Denoising steps per prediction (DDIM).
 *   n_action_steps (an int 1..=1000, default 8): Actions of a prediction that are executed before the next one.
 *   seed (an int, default 0): Seed of the noise, at the start of a stream.
 *
 * Inputs:
 *   observation (Observation)
 *
 * Outputs:
 *   target (RlTarget)
 */
static inline opendr_status opendr_load_diffusion_policy(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("diffusion_policy", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_diffusion_policy(const opendr_learner *learner,
    const opendr_observation *observation,
    opendr_rl_target **target) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "observation";
    inputs_[0].value = (const opendr_value *)observation;
    outputs_[0].name = "target";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (target != NULL) *target = (opendr_rl_target *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * EndToEndPlanningRLLearner: Flies a drone between obstacles: maps its depth images to heading and yaw.
 *
 * Parameters:
 *   deterministic (a bool, live, default true): Whether the policy takes its most likely actions instead of sampling.
 *   seed (an int, default 0): Seed of sampled actions, at the start of a stream.
 *
 * Inputs:
 *   observation (Observation)
 *
 * Outputs:
 *   target (RlTarget)
 */
static inline opendr_status opendr_load_end_to_end_planning(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("end_to_end_planning", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_end_to_end_planning(const opendr_learner *learner,
    const opendr_observation *observation,
    opendr_rl_target **target) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "observation";
    inputs_[0].value = (const opendr_value *)observation;
    outputs_[0].name = "target";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (target != NULL) *target = (opendr_rl_target *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * ActiveFaceRecognitionLearner: Recognises a person from several views, and proposes the camera motion to the next one.
 *
 * Parameters:
 *   moves (an int 0..=100, live, default 6): Maximum number of motions for a subject.
 *   confidence (a float 0..=1, live, default 0.97): Probability of the most likely class at which no further motion is proposed.
 *   min_gain (a float 0..=1, live, default 0): Expected rise of the probability of the true class below which no further motion is proposed; 0 disables the rule.
 *
 * Inputs:
 *   image (Image): Image of the camera.
 *   pose (Observation): Pose of the camera: azimuth (rad), elevation (rad), distance. Without it, the proposed motions are assumed to have been carried out. Optional: may be NULL.
 *
 * Outputs:
 *   category (Category)
 */
static inline opendr_status opendr_load_active_face_recognition(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("active_face_recognition", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_active_face_recognition(const opendr_learner *learner,
    const opendr_image *image,
    const opendr_observation *pose,
    opendr_category **category) {
    opendr_input inputs_[2];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    inputs_[1].name = "pose";
    inputs_[1].value = (const opendr_value *)pose;
    outputs_[0].name = "category";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 2, outputs_, 1);
    if (category != NULL) *category = (opendr_category *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * ActiveObjectRecognitionLearner: Recognises an object from several views, and proposes the camera motion to the next one.
 *
 * Parameters:
 *   moves (an int 0..=100, live, default 6): Maximum number of motions for a subject.
 *   confidence (a float 0..=1, live, default 0.97): Probability of the most likely class at which no further motion is proposed.
 *   min_gain (a float 0..=1, live, default 0): Expected rise of the probability of the true class below which no further motion is proposed; 0 disables the rule.
 *
 * Inputs:
 *   image (Image): Image of the camera.
 *   pose (Observation): Pose of the camera: azimuth (rad), elevation (rad), distance. Without it, the proposed motions are assumed to have been carried out. Optional: may be NULL.
 *
 * Outputs:
 *   category (Category)
 */
static inline opendr_status opendr_load_active_object_recognition(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("active_object_recognition", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_active_object_recognition(const opendr_learner *learner,
    const opendr_image *image,
    const opendr_observation *pose,
    opendr_category **category) {
    opendr_input inputs_[2];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    inputs_[1].name = "pose";
    inputs_[1].value = (const opendr_value *)pose;
    outputs_[0].name = "category";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 2, outputs_, 1);
    if (category != NULL) *category = (opendr_category *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * ActivePoseRecognitionLearner: Recognises a person's pose from several views, and proposes the camera motion to the next one.
 *
 * Parameters:
 *   moves (an int 0..=100, live, default 6): Maximum number of motions for a subject.
 *   confidence (a float 0..=1, live, default 0.97): Probability of the most likely class at which no further motion is proposed.
 *   min_gain (a float 0..=1, live, default 0): Expected rise of the probability of the true class below which no further motion is proposed; 0 disables the rule.
 *
 * Inputs:
 *   image (Image): Image of the camera.
 *   pose (Observation): Pose of the camera: azimuth (rad), elevation (rad), distance. Without it, the proposed motions are assumed to have been carried out. Optional: may be NULL.
 *
 * Outputs:
 *   category (Category)
 */
static inline opendr_status opendr_load_active_pose_recognition(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("active_pose_recognition", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_active_pose_recognition(const opendr_learner *learner,
    const opendr_image *image,
    const opendr_observation *pose,
    opendr_category **category) {
    opendr_input inputs_[2];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    inputs_[1].name = "pose";
    inputs_[1].value = (const opendr_value *)pose;
    outputs_[0].name = "category";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 2, outputs_, 1);
    if (category != NULL) *category = (opendr_category *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

/*
 * SingleDemoGraspLearner: Learns to grasp an object from one image with the places of the jaws, and predicts them in other images.
 *
 * Parameters:
 *   threshold (a float 0..=1, live, default 0.5): Minimum confidence of a grasp: that of its less certain jaw.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   poses (PoseList)
 */
static inline opendr_status opendr_load_single_demo_grasp(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("single_demo_grasp", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_single_demo_grasp(const opendr_learner *learner,
    const opendr_image *image,
    opendr_pose_list **poses) {
    opendr_input inputs_[1];
    opendr_output outputs_[1];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    outputs_[0].name = "poses";
    outputs_[0].value = NULL;
    status_ = opendr_infer(learner, inputs_, 1, outputs_, 1);
    if (poses != NULL) *poses = (opendr_pose_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    return status_;
}

#endif /* OPENDR_H */
