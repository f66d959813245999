#ifndef OPENDR_H
#define OPENDR_H

/*
 * OpenDR in Rust: the C API. Made from the library; docs/c.md explains it.
 *
 * The rules:
 *   - A function that answers opendr_status answers OPENDR_OK (0) or why it failed; opendr_last_error() tells it in words.
 *   - What a function writes to an opendr_X ** is a new handle, NULL when the call fails. Free it with opendr_X_free(),
 *     which takes the address of the variable and makes it NULL; freeing NULL is fine.
 *   - What a function points to (texts, numbers, pixels) belongs to the handle it was asked of, and lives as long as it.
 *   - What is handed in is copied, or only read during the call; it stays the caller's.
 *   - Texts are UTF-8. Paths are bytes as the system has them.
 *   - Learners, networks and sources may be used by several threads at once; values as long as nobody changes or frees them.
 *   - NULL, handles of another type, and lengths that cannot be are refused. That a pointer leads to as much memory as its
 *     length says, and that a handle is not used after it was freed, is the caller's promise.
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
typedef struct opendr_speech_command opendr_speech_command;
typedef struct opendr_base_transcription opendr_base_transcription;
typedef struct opendr_whisper_transcription opendr_whisper_transcription;
typedef struct opendr_vosk_transcription opendr_vosk_transcription;
typedef struct opendr_rl_target opendr_rl_target;

// The time stamp of a value that has none.
#define OPENDR_NO_STAMP INT64_MIN

// How a call went; the numbers are the exit codes of the command `opendr`.
typedef enum opendr_status {
    // All went well.
    OPENDR_OK = 0,
    // A datum, target, pointer or file handed in does not fit: null, wrong shape, empty, NaN, undecodable picture.
    OPENDR_INVALID_INPUT = 11,
    // A parameter is unknown, of the wrong type or out of range.
    OPENDR_INVALID_PARAM = 12,
    // A file, model, learner, device node or class name does not exist.
    OPENDR_NOT_FOUND = 13,
    // The operating system refused to read or write.
    OPENDR_IO = 14,
    // A server or package client could not be reached or broke off.
    OPENDR_NETWORK = 15,
    // Bytes differ from their checksum or stated size, or an archive member leaves its folder.
    OPENDR_INTEGRITY = 16,
    // A file or message does not follow its format.
    OPENDR_FORMAT = 17,
    // This learner, runtime or build cannot do what was asked.
    OPENDR_UNSUPPORTED = 18,
    // The device asked for is not there or failed.
    OPENDR_DEVICE = 19,
    // A fault of OpenDR itself: please report it.
    OPENDR_INTERNAL = 20,
} opendr_status;

// The type of a picture's samples.
typedef enum opendr_samples {
    // 8 bits, 0 to 255.
    OPENDR_U8 = 0,
    // 16 bits: depth in millimetres, thermal counts.
    OPENDR_U16 = 1,
    // Floats: depth in metres, or colours.
    OPENDR_F32 = 2,
} opendr_samples;

// The channels of a picture in memory.
typedef enum opendr_pixel_format {
    // One channel: brightness, depth.
    OPENDR_GREY = 0,
    // Red, green, blue.
    OPENDR_RGB = 1,
    // Blue, green, red (OpenCV).
    OPENDR_BGR = 2,
    // Red, green, blue, opacity.
    OPENDR_RGBA = 3,
    // Blue, green, red, opacity.
    OPENDR_BGRA = 4,
} opendr_pixel_format;

// The order of the axes of a picture in memory.
typedef enum opendr_layout {
    // [height, width, channels]: pixels lie together (cameras, OpenCV).
    OPENDR_HWC = 0,
    // [channels, height, width]: planes lie together (networks).
    OPENDR_CHW = 1,
} opendr_layout;

// The joints of a kind of body, and their order (docs/json.md).
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
    // The 25 joints of a person that Kinect v2 tells, as NTU RGB+D numbers them.
    OPENDR_NTU25 = 7,
    // Where the two jaws of a gripper go to grasp a thing.
    OPENDR_GRASP2 = 8,
} opendr_skeleton;

// A world to act in; threads take turns.
typedef struct opendr_env opendr_env;

// A learner with its model; threads may use it at once, one call is answered after the other.
typedef struct opendr_learner opendr_learner;

// A network; threads may run it at once, one run after the other.
typedef struct opendr_network opendr_network;

// Pictures one after the other; two threads may take from it at once.
typedef struct opendr_source opendr_source;

// A text that the library made; free it with opendr_string_free().
typedef struct opendr_string opendr_string;

// The outputs of one run of a network.
typedef struct opendr_tensors opendr_tensors;

// A datum or target of any type; a pointer to a handle of a data or target type may be cast to it.
typedef struct opendr_value opendr_value;

// The matrices of a calibration, row by row, as KITTI names them.
typedef struct opendr_calibration_matrices {
    // Projection of the rectified camera frame into the left colour picture.
    double p2[3][4];
    // Rectifying rotation.
    double r0_rect[3][3];
    // From the lidar's frame to the camera's, metres.
    double tr_velo_to_cam[3][4];
} opendr_calibration_matrices;

// Pixels in memory.
typedef struct opendr_pixels {
    // The first sample.
    const void *data;
    // Bytes from the first sample to the end of the memory.
    size_t size;
    // Pixels a row.
    size_t width;
    // Rows.
    size_t height;
    // Bytes from one row to the next; 0 when rows follow each other without a gap. Planes are height rows.
    size_t row_stride;
    // One of opendr_samples.
    int32_t samples;
    // One of opendr_pixel_format.
    int32_t format;
    // One of opendr_layout.
    int32_t layout;
} opendr_pixels;

// A named part of an observation.
typedef struct opendr_observation_part {
    // Its name.
    const char *name;
    // Its numbers, last axis fastest.
    const float *numbers;
    // How many numbers there are.
    size_t length;
    // The sizes of its axes.
    const size_t *shape;
    // How many axes there are.
    size_t axes;
} opendr_observation_part;

// What an environment is like.
typedef struct opendr_env_spec {
    // Name and version; lives as long as the environment.
    const char *id;
    // What is seen, in Gymnasium's words; lives as long as the environment.
    const char *observation_space;
    // What can be done, in Gymnasium's words; lives as long as the environment.
    const char *action_space;
    // How many numbers an observation has.
    size_t observation_length;
    // How many numbers an action has.
    size_t action_length;
    // After how many steps an episode is truncated; 0 for never.
    uint32_t max_episode_steps;
} opendr_env_spec;

// What a step earned, and whether the episode is over.
typedef struct opendr_env_step_result {
    // The reward.
    double reward;
    // The task itself ended.
    bool terminated;
    // The episode was cut by a time limit.
    bool truncated;
} opendr_env_step_result;

// Hears how long work goes: context is what was handed in with it, what the work in words, done of total (0 when it is not
// known) what is done, status how it goes right now ("loss 0.31, 42 images/s", "" when there is nothing to say). It answers
// whether to go on. It is called by one thread at a time, not always the same one, and must not use the learner that works.
typedef bool (*opendr_progress)(void *context, const char *what, uint64_t done, uint64_t total, const char *status);

// A named input.
typedef struct opendr_input {
    // The input's name, e.g. "image".
    const char *name;
    // Any data or target; NULL leaves an optional input out.
    const struct opendr_value *value;
} opendr_input;

// A named output.
typedef struct opendr_output {
    // The output's name, e.g. "boxes".
    const char *name;
    // What was found, to be freed; set by the call, NULL when it failed.
    struct opendr_value *value;
} opendr_output;

// A tensor in memory, its last axis fastest.
typedef struct opendr_tensor {
    // Name within the network; NULL for an input that is given in its place in the order.
    const char *name;
    // The numbers.
    const float *numbers;
    // How many there are: the product of the shape.
    size_t length;
    // Size of each axis.
    const size_t *shape;
    // Number of axes, at most 8.
    size_t axes;
} opendr_tensor;

// What a network declares of an input or output; it lives as long as the network.
typedef struct opendr_tensor_info {
    // Name within the network.
    const char *name;
    // Size of each axis, 0 where any size will do.
    const size_t *shape;
    // Number of axes; 0 for a single number, and where the network does not declare them.
    size_t axes;
} opendr_tensor_info;

// How a picture becomes the input of a network: scaled, (level - mean) / std by channel, in the order of the axes.
typedef struct opendr_preprocess {
    // Pixels of a row of the input.
    size_t width;
    // Rows of the input.
    size_t height;
    // The channels of the input: OPENDR_GREY, OPENDR_RGB or OPENDR_BGR.
    int32_t format;
    // One of opendr_layout.
    int32_t layout;
    // Of each channel, in levels of 0 to 255; grey has the first.
    float mean[3];
    // Of each channel, in levels of 0 to 255, not 0.
    float std[3];
    // The level beside a picture that keeps its aspect ratio and stands in the middle; NaN stretches it instead.
    float pad;
} opendr_preprocess;

// A box in space, in the camera frame of KITTI: x right, y down, z ahead.
typedef struct opendr_bounding_box_3d {
    // Class number; -1 when there is only a label.
    int64_t class_index;
    // What the class is called, NULL when that is not known. Given to a list, it counts when class_index is -1.
    const char *label;
    // How much of the object lies outside the picture, 0 to 1; -1 when it is not known.
    float truncated;
    // 0 visible, 1 partly hidden, 2 mostly hidden, 3 or -1 not known.
    int32_t occluded;
    // Angle under which the object is seen, radians.
    float alpha;
    // The object in the picture, corners x0, y0, x1, y1, pixels.
    float bbox2d[4];
    // Length, height and width, metres.
    float dimensions[3];
    // x, y, z of the middle of its floor, metres.
    float location[3];
    // Turn about the vertical axis, radians; 0 looks along x.
    float rotation_y;
    // Score.
    float confidence;
} opendr_bounding_box_3d;

// A point in a picture, pixels.
typedef struct opendr_point {
    // Pixels from the left edge.
    float x;
    // Pixels from the upper edge.
    float y;
} opendr_point;

// A box in a picture. Outlines (segments) are in the JSON of the list.
typedef struct opendr_bounding_box {
    // Class number; -1 when there is only a label.
    int64_t class_index;
    // What the class is called, NULL when that is not known. Given to a list, it counts when class_index is -1.
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
    // Points that belong to the box (eyes, nose, corners of the mouth of a face).
    const struct opendr_point *landmarks;
    // How many there are.
    size_t landmark_count;
} opendr_bounding_box;

// What a category says.
typedef struct opendr_category_fields {
    // Class number.
    int64_t class_index;
    // What the class means, NULL when that is not known.
    const char *description;
    // Score of the class, 0 to 1; NaN when there is none.
    float confidence;
    // Score of every class.
    const float *probabilities;
    // How many there are; 0 when the learner does not tell them.
    size_t probability_count;
} opendr_category_fields;

// The elements of a heat map, last axis fastest: either labels or scores, the other is NULL.
typedef struct opendr_heatmap_fields {
    // Class numbers.
    const uint32_t *labels;
    // Scores.
    const float *scores;
    // How many elements there are.
    size_t length;
    // The sizes of the axes, e.g. height and width.
    const size_t *shape;
    // How many axes there are, 1 to 8.
    size_t axes;
} opendr_heatmap_fields;

// A point found in a picture, pixels; (-1, -1) means not found.
typedef struct opendr_keypoint {
    // Pixels from the left edge.
    float x;
    // Pixels from the upper edge.
    float y;
    // Score, 0 to 1.
    float confidence;
} opendr_keypoint;

// One person.
typedef struct opendr_pose {
    // The joints in the order of the skeleton.
    const struct opendr_keypoint *keypoints;
    // How many there are.
    size_t keypoint_count;
    // Score of the whole, 0 to 1.
    float confidence;
    // One of opendr_skeleton.
    int32_t skeleton;
    // The person's track; -1 when none is kept.
    int64_t id;
} opendr_pose;

// What a command says.
typedef struct opendr_speech_command_fields {
    // Class number; -1 when there is only a word.
    int64_t class_index;
    // The word, NULL when it is not known. Given to a command, it counts when class_index is -1.
    const char *label;
    // Score, 0 to 1.
    float confidence;
    // Begin within the sound, seconds; NaN when it is not known.
    float begin_s;
    // End within the sound, seconds; NaN when it is not known.
    float end_s;
} opendr_speech_command_fields;

// A box of one object that is followed through space.
typedef struct opendr_tracking_annotation_3d {
    // Where it is.
    struct opendr_bounding_box_3d bounding_box_3d;
    // The object's number, the same at every time; -1 when it is not known.
    int64_t id;
    // Number of the cloud in its recording; -1 when it has none.
    int64_t frame;
} opendr_tracking_annotation_3d;

// A box of one object that is followed through a video.
typedef struct opendr_tracking_annotation {
    // Where it is.
    struct opendr_bounding_box bounding_box;
    // The object's number, the same in every picture; -1 when it is not known.
    int64_t id;
    // Number of the picture in its video; -1 when it has none.
    int64_t frame;
} opendr_tracking_annotation;

// A part of a transcription. Tokens and measures are in the JSON of the transcription.
typedef struct opendr_whisper_segment {
    // Number of the segment.
    int64_t id;
    // Begin within the sound, seconds.
    float start_s;
    // End within the sound, seconds.
    float end_s;
    // The words.
    const char *text;
} opendr_whisper_segment;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// The text under a key of a JSON object, or of the object under section where that is not NULL; of a list, the item at
// index. "" when there is none. Valid until the next call of this thread.
const char *opendr_json_text(const char *json, const char *section, const char *key, int32_t index);

// The number under a key, as opendr_json_text() finds it; 0 when there is none.
double opendr_json_number(const char *json, const char *section, const char *key, int32_t index);

// Makes a datum of the named type ("Vector", "PointCloud", ...) of length numbers, which are copied, last axis fastest.
enum opendr_status opendr_array_create(const char *type_name,
                                       const float *numbers,
                                       size_t length,
                                       const size_t *shape,
                                       size_t axes,
                                       struct opendr_value **value);

// Shows the numbers of such a datum and the sizes of its axes; shape has room for axes sizes, as many as the type has.
// The numbers live as long as the datum.
enum opendr_status opendr_array_read(const struct opendr_value *value,
                                     const float **numbers,
                                     size_t *length,
                                     size_t *shape,
                                     size_t axes);

// Makes a sound of length samples in [-1, 1], which are copied, instant by instant (channels interleaved).
enum opendr_status opendr_audio_create(const float *samples,
                                       size_t length,
                                       size_t channels,
                                       uint32_t sample_rate,
                                       opendr_audio **audio);

// Shows the samples of a sound, which live as long as it.
enum opendr_status opendr_audio_read(const opendr_audio *audio,
                                     const float **samples,
                                     size_t *length,
                                     size_t *channels,
                                     uint32_t *sample_rate);

// Makes a calibration of its matrices.
enum opendr_status opendr_calibration_create(const struct opendr_calibration_matrices *matrices,
                                             opendr_calibration **calibration);

// Reads a calibration file of KITTI's detection or tracking benchmark.
enum opendr_status opendr_calibration_open(const char *path, opendr_calibration **calibration);

// Copies the matrices of a calibration.
enum opendr_status opendr_calibration_read(const opendr_calibration *calibration,
                                           struct opendr_calibration_matrices *matrices);

// Reads a picture file: JPEG, PNG, BMP or WebP.
enum opendr_status opendr_image_open(const char *path, opendr_image **image);

// Reads a picture from the bytes of a file.
enum opendr_status opendr_image_decode(const uint8_t *bytes, size_t size, opendr_image **image);

// Makes a picture of pixels in memory, which are copied.
enum opendr_status opendr_image_create(const struct opendr_pixels *pixels, opendr_image **image);

// Shows the pixels of a picture as they are stored; they live as long as the picture, and until it is drawn onto.
enum opendr_status opendr_image_read(const opendr_image *image, struct opendr_pixels *pixels);

// Writes a picture file; the extension of its name tells the format: .jpg, .png, .bmp or .webp.
enum opendr_status opendr_image_save(const opendr_image *image, const char *path);

// Makes a picture with boxes; picture and boxes stay the caller's.
enum opendr_status opendr_image_with_detections_create(const opendr_image *image,
                                                       const opendr_bounding_box_list *boxes,
                                                       opendr_image_with_detections **both);

// Gives new handles of the picture and of the boxes, to be freed.
enum opendr_status opendr_image_with_detections_read(const opendr_image_with_detections *both,
                                                     opendr_image **image,
                                                     opendr_bounding_box_list **boxes);

// Makes an observation of length numbers without parts, which are copied.
enum opendr_status opendr_observation_create(const float *numbers, size_t length, opendr_observation **observation);

// Makes an observation of named parts, which are copied.
enum opendr_status opendr_observation_create_parts(const struct opendr_observation_part *parts,
                                                   size_t count,
                                                   opendr_observation **observation);

// Shows all numbers of an observation in a row, which live as long as it.
enum opendr_status opendr_observation_read(const opendr_observation *observation,
                                           const float **numbers,
                                           size_t *length);

// How many named parts an observation has; 0 for what is none.
size_t opendr_observation_part_count(const opendr_observation *observation);

// Shows a part of an observation; what it points to lives as long as the observation.
enum opendr_status opendr_observation_get(const opendr_observation *observation,
                                          size_t index,
                                          struct opendr_observation_part *part);

// Makes a cloud with its calibration, which both stay the caller's. image_shape is the height and width of the camera's
// picture in pixels, or NULL.
enum opendr_status opendr_point_cloud_with_calibration_create(const opendr_point_cloud *cloud,
                                                              const opendr_calibration *calibration,
                                                              const size_t *image_shape,
                                                              opendr_point_cloud_with_calibration **both);

// Gives new handles of the cloud and of the calibration, to be freed; height and width of the picture are 0 when they
// are not known.
enum opendr_status opendr_point_cloud_with_calibration_read(const opendr_point_cloud_with_calibration *both,
                                                            opendr_point_cloud **cloud,
                                                            opendr_calibration **calibration,
                                                            size_t *height,
                                                            size_t *width);

// Draws a target onto a picture; a type that has no place in a picture leaves it as it is. Copies of the picture stay
// as they are.
enum opendr_status opendr_value_draw(const struct opendr_value *target, opendr_image *image);

// Makes an environment, e.g. "CartPole-v1".
//
// params_json is an object of its parameters; NULL takes the defaults.
enum opendr_status opendr_env_make(const char *id, const char *params_json, struct opendr_env **env);

// Tells what an environment is like.
enum opendr_status opendr_env_describe(const struct opendr_env *env, struct opendr_env_spec *spec);

// Begins an episode; observation, which may be NULL, receives what is seen, to be freed.
//
// A seed fixes everything random until the next one; NULL goes on with the stream of random numbers.
enum opendr_status opendr_env_reset(struct opendr_env *env, const uint64_t *seed, opendr_observation **observation);

// Takes a step with an action of count numbers; observation, which may be NULL, receives what is seen, to be freed.
enum opendr_status opendr_env_step(struct opendr_env *env,
                                   const float *action,
                                   size_t count,
                                   struct opendr_env_step_result *result,
                                   opendr_observation **observation);

// A number that the last reset or step told beside observation and reward, e.g. "success".
enum opendr_status opendr_env_info(const struct opendr_env *env, const char *name, double *value);

// Frees an environment and makes the variable NULL.
enum opendr_status opendr_env_close(struct opendr_env **env);

// Measures the learner on a data set on disk.
//
// dataset_type is its format, e.g. "coco"; NULL recognises it. options_json is an object: "metric", "metric_params",
// "split", "limit", "out", "skip_broken", "classes" (an object: classes of the data set by classes of the learner), "by_number",
// "resamples", and "then", a list of pretrained learners behind this one, such as ["byte_track"], so that the pipeline is
// measured; NULL takes the defaults. The outcome is an object of JSON: under "scalars" the numbers by name; it is to be freed.
enum opendr_status opendr_eval(const struct opendr_learner *learner,
                               const char *dataset,
                               const char *dataset_type,
                               const char *options_json,
                               struct opendr_string **outcome);

// Trains the learner on a data set on disk, from its model where it has one, and loads the result.
//
// dataset_type is its format, e.g. "coco"; NULL recognises it. options_json is an object: "params" (of the training), "split",
// "val", "val_format", "val_split", "limit", "out", "logging_path", "resume", "teacher", "teacher_threshold",
// "teacher_classes", "keep_empty", "skip_broken"; NULL takes the defaults. progress, which may be NULL, hears how it goes
// and may stop it: what was done is then saved, to be resumed. The report is an object of JSON: under "curves" and
// "scalars" the numbers by name, under "model" the path of the trained container; it is to be freed.
enum opendr_status opendr_fit(const struct opendr_learner *learner,
                              const char *dataset,
                              const char *dataset_type,
                              const char *options_json,
                              opendr_progress progress,
                              void *context,
                              struct opendr_string **report);

// Trains a policy in environments that id names, e.g. "CartPole-v1", from its model where it has one, and loads the result.
//
// env_params_json is an object of parameters of the environment; NULL takes the defaults. options_json is an object:
// "params" (of the training), "out", "logging_path", "resume"; NULL takes the defaults. progress and report are as
// those of opendr_fit.
enum opendr_status opendr_fit_in(const struct opendr_learner *learner,
                                 const char *id,
                                 const char *env_params_json,
                                 const char *options_json,
                                 opendr_progress progress,
                                 void *context,
                                 struct opendr_string **report);

// Loads a learner, e.g. "nanodet" or "yunet/320".
//
// path is a model container of your own; NULL takes the pretrained model, which is downloaded the first time. device is
// "cpu", "cuda:0", ...; NULL takes the best one there is. params_json is an object of parameters; NULL takes the defaults.
enum opendr_status opendr_load(const char *name,
                               const char *path,
                               const char *device,
                               const char *params_json,
                               struct opendr_learner **learner);

// Makes a learner without a model, e.g. "ssd", to be trained by opendr_fit. device and params_json are as for
// opendr_load.
enum opendr_status opendr_create(const char *name,
                                 const char *device,
                                 const char *params_json,
                                 struct opendr_learner **learner);

// Answers named inputs on the learner's own stream. Each output asked for gets a new handle, to be freed; outputs may be
// left out. Inputs stay the caller's.
enum opendr_status opendr_infer(const struct opendr_learner *learner,
                                const struct opendr_input *inputs,
                                size_t input_count,
                                struct opendr_output *outputs,
                                size_t output_count);

// The name of the learner's input number index, NULL after the last. It lives as long as the learner.
const char *opendr_input_name(const struct opendr_learner *learner, size_t index);

// The type of the learner's input number index, e.g. "Image"; NULL after the last. It lives as long as the learner.
const char *opendr_input_type(const struct opendr_learner *learner, size_t index);

// The name of the learner's output number index, NULL after the last. It lives as long as the learner.
const char *opendr_output_name(const struct opendr_learner *learner, size_t index);

// Sets a parameter that may change while the learner runs; value_json is a number, text, boolean, list or null.
enum opendr_status opendr_set_param(const struct opendr_learner *learner, const char *name, const char *value_json);

// The parameters in force as a JSON object.
enum opendr_status opendr_params(const struct opendr_learner *learner, struct opendr_string **json);

// Forgets what the learner's own stream remembers.
enum opendr_status opendr_reset(const struct opendr_learner *learner);

// The names of the classes in order, as a JSON list; empty when class numbers have no names.
enum opendr_status opendr_classes(const struct opendr_learner *learner, struct opendr_string **json);

// How many classes have names.
enum opendr_status opendr_class_count(const struct opendr_learner *learner, size_t *count);

// The name of a class, NULL when it has none. It lives as long as the learner.
const char *opendr_class_name(const struct opendr_learner *learner, int64_t class_index);

// Writes the model with the parameters in force as a container to the folder path.
enum opendr_status opendr_save(const struct opendr_learner *learner, const char *path);

// Frees the learner and makes the variable NULL; a NULL in it is freed already.
enum opendr_status opendr_learner_free(struct opendr_learner **learner);

// The learners that there are, as a JSON list of their names.
enum opendr_status opendr_learners(struct opendr_string **json);

// Opens a network without its learner. path is an ONNX file (*.onnx) or a model container: a folder, its JSON (OpenDR's
// too) or a zip.
//
// file names the ONNX file within a container, e.g. "encoder.onnx" or "detector/model.onnx"; NULL takes its only one. device
// is "cpu", "cuda:0", ...; NULL takes the best one there is. A network that takes other numbers than floats is
// OPENDR_UNSUPPORTED.
enum opendr_status opendr_network_open(const char *path,
                                       const char *file,
                                       const char *device,
                                       struct opendr_network **network);

// Opens the network of a loaded learner once more, on the learner's device, to run it without what the learner does before
// and after. file is as for opendr_network_open(); the learner may be freed.
enum opendr_status opendr_network_of(const struct opendr_learner *learner,
                                     const char *file,
                                     struct opendr_network **network);

// Runs a network. Each input is given once, by its name or, where that is NULL, in its place in the order. tensors receives
// the outputs in the network's order, to be freed.
enum opendr_status opendr_network_run(const struct opendr_network *network,
                                      const struct opendr_tensor *inputs,
                                      size_t input_count,
                                      struct opendr_tensors **tensors);

// Returns the number of the network's inputs.
size_t opendr_network_input_count(const struct opendr_network *network);

// Returns the number of the network's outputs.
size_t opendr_network_output_count(const struct opendr_network *network);

// Writes what the network declares of its input number index, counted from 0.
enum opendr_status opendr_network_input(const struct opendr_network *network,
                                        size_t index,
                                        struct opendr_tensor_info *info);

// Writes what the network declares of its output number index, counted from 0.
enum opendr_status opendr_network_output(const struct opendr_network *network,
                                         size_t index,
                                         struct opendr_tensor_info *info);

// Writes the model.json of the network's container as JSON ("learner", "params", "classes", "inputs", ...), to be freed;
// "{}" for an ONNX file.
enum opendr_status opendr_network_manifest(const struct opendr_network *network,
                                           struct opendr_string **json);

// Frees the network and makes the variable NULL; a NULL in it is freed already.
enum opendr_status opendr_network_free(struct opendr_network **network);

// Writes the input of a network that is made of a picture: length numbers, width * height * channels.
enum opendr_status opendr_image_preprocess(const opendr_image *image,
                                           const struct opendr_preprocess *how,
                                           float *numbers,
                                           size_t length);

// Opens a picture, a folder, a pattern ("photos/\*.jpg"), a video, or a camera ("camera:0").
enum opendr_status opendr_source_open(const char *input, struct opendr_source **source);

// The next picture, to be freed; *image is NULL at the end. After a file that cannot be read, the next call goes on with
// the next file.
enum opendr_status opendr_source_next(struct opendr_source *source,
                                      opendr_image **image);

// The file that the last picture, or the last failure, came from; "" for a camera, and when there was none yet. Valid
// until the next call with this source.
const char *opendr_source_path(const struct opendr_source *source);

// Closes the source and makes the variable NULL; a NULL in it is closed already.
enum opendr_status opendr_source_free(struct opendr_source **source);

// Why the last call of this thread that failed did so; "" when none did. Valid until the next failing call of this
// thread.
const char *opendr_last_error(void);

// Makes message what opendr_last_error() returns in this thread: for functions that are written over these.
void opendr_set_last_error(const char *message);

// The name of a status, e.g. "InvalidInput"; "unknown" for other numbers.
const char *opendr_status_name(int32_t status);

// The version of the library, e.g. "0.1.0".
const char *opendr_version(void);

// The bytes of the text in UTF-8, ended by a zero; NULL for what is no string. They live as long as the string.
const char *opendr_string_text(const struct opendr_string *string);

// How many bytes the text has, the zero at its end not counted.
size_t opendr_string_length(const struct opendr_string *string);

// Frees the string and makes the variable NULL; a NULL in it is freed already.
enum opendr_status opendr_string_free(struct opendr_string **string);

// Makes a list of items, which are copied.
enum opendr_status opendr_bounding_box_3d_list_create(const struct opendr_bounding_box_3d *items,
                                                      size_t count,
                                                      opendr_bounding_box_3d_list **list);

// How many boxes there are; 0 for what is no such list.
size_t opendr_bounding_box_3d_list_count(const opendr_bounding_box_3d_list *list);

// Shows an item of the list; what it points to lives as long as the list.
enum opendr_status opendr_bounding_box_3d_list_get(const opendr_bounding_box_3d_list *list,
                                                   size_t index,
                                                   struct opendr_bounding_box_3d *item);

// Makes a list of items, which are copied.
enum opendr_status opendr_bounding_box_list_create(const struct opendr_bounding_box *items,
                                                   size_t count,
                                                   opendr_bounding_box_list **list);

// How many boxes there are; 0 for what is no such list.
size_t opendr_bounding_box_list_count(const opendr_bounding_box_list *list);

// Shows an item of the list; what it points to lives as long as the list.
enum opendr_status opendr_bounding_box_list_get(const opendr_bounding_box_list *list,
                                                size_t index,
                                                struct opendr_bounding_box *item);

// Makes a category; everything is copied.
enum opendr_status opendr_category_create(const struct opendr_category_fields *fields, opendr_category **category);

// Shows what a category says; what the fields point to lives as long as the category.
enum opendr_status opendr_category_read(const opendr_category *category, struct opendr_category_fields *fields);

// Makes a heat map; everything is copied.
enum opendr_status opendr_heatmap_create(const struct opendr_heatmap_fields *fields, opendr_heatmap **heatmap);

// Shows the elements of a heat map, which live as long as it.
enum opendr_status opendr_heatmap_read(const opendr_heatmap *heatmap, struct opendr_heatmap_fields *fields);

// Makes a list of items, which are copied.
enum opendr_status opendr_pose_list_create(const struct opendr_pose *items, size_t count, opendr_pose_list **list);

// How many persons there are; 0 for what is no such list.
size_t opendr_pose_list_count(const opendr_pose_list *list);

// Shows an item of the list; what it points to lives as long as the list.
enum opendr_status opendr_pose_list_get(const opendr_pose_list *list, size_t index, struct opendr_pose *item);

// Makes an action of count numbers, which are copied.
enum opendr_status opendr_rl_target_create(const float *values, size_t count, opendr_rl_target **target);

// Shows the numbers of an action in a row, as the action space lays them out; they live as long as it.
enum opendr_status opendr_rl_target_read(const opendr_rl_target *target, const float **values, size_t *count);

// Makes a command; everything is copied.
enum opendr_status opendr_speech_command_create(const struct opendr_speech_command_fields *fields,
                                                opendr_speech_command **command);

// Shows what a command says; the word lives as long as the command.
enum opendr_status opendr_speech_command_read(const opendr_speech_command *command,
                                              struct opendr_speech_command_fields *fields);

// Makes a list of items, which are copied.
enum opendr_status opendr_tracking_annotation_3d_list_create(const struct opendr_tracking_annotation_3d *items,
                                                             size_t count,
                                                             opendr_tracking_annotation_3d_list **list);

// How many tracks there are; 0 for what is no such list.
size_t opendr_tracking_annotation_3d_list_count(const opendr_tracking_annotation_3d_list *list);

// Shows an item of the list; what it points to lives as long as the list.
enum opendr_status opendr_tracking_annotation_3d_list_get(const opendr_tracking_annotation_3d_list *list,
                                                          size_t index,
                                                          struct opendr_tracking_annotation_3d *item);

// Makes a list of items, which are copied.
enum opendr_status opendr_tracking_annotation_list_create(const struct opendr_tracking_annotation *items,
                                                          size_t count,
                                                          opendr_tracking_annotation_list **list);

// How many tracks there are; 0 for what is no such list.
size_t opendr_tracking_annotation_list_count(const opendr_tracking_annotation_list *list);

// Shows an item of the list; what it points to lives as long as the list.
enum opendr_status opendr_tracking_annotation_list_get(const opendr_tracking_annotation_list *list,
                                                       size_t index,
                                                       struct opendr_tracking_annotation *item);

// Makes a transcription of words.
enum opendr_status opendr_base_transcription_create(const char *text, opendr_base_transcription **transcription);

// The words, NULL for what is no such transcription; they live as long as it.
const char *opendr_base_transcription_text(const opendr_base_transcription *transcription);

// Makes a transcription of words so far; finished tells whether the phrase is.
enum opendr_status opendr_vosk_transcription_create(const char *text,
                                                    bool finished,
                                                    opendr_vosk_transcription **transcription);

// The words so far, NULL for what is no such transcription; they live as long as it.
const char *opendr_vosk_transcription_text(const opendr_vosk_transcription *transcription);

// Whether the phrase is finished: the words will not change any more.
bool opendr_vosk_transcription_finished(const opendr_vosk_transcription *transcription);

// Makes a transcription of words and its segments, which are copied.
enum opendr_status opendr_whisper_transcription_create(const char *text,
                                                       const struct opendr_whisper_segment *segments,
                                                       size_t count,
                                                       opendr_whisper_transcription **transcription);

// The words, NULL for what is no such transcription; they live as long as it.
const char *opendr_whisper_transcription_text(const opendr_whisper_transcription *transcription);

// How many segments there are; 0 for what is no such transcription.
size_t opendr_whisper_transcription_count(const opendr_whisper_transcription *transcription);

// Shows a segment; its words live as long as the transcription.
enum opendr_status opendr_whisper_transcription_get(const opendr_whisper_transcription *transcription,
                                                    size_t index,
                                                    struct opendr_whisper_segment *segment);

// Returns the number of tensors.
size_t opendr_tensors_count(const struct opendr_tensors *tensors);

// Writes where tensor number index lies, counted from 0; it lives as long as the tensors. Integers and truth values of a
// network are rounded to floats.
enum opendr_status opendr_tensors_get(const struct opendr_tensors *tensors,
                                      size_t index,
                                      struct opendr_tensor *tensor);

// Frees the tensors and makes the variable NULL; a NULL in it is freed already.
enum opendr_status opendr_tensors_free(struct opendr_tensors **tensors);

// The name of the value's type, e.g. "BoundingBoxList"; NULL for what is no value. It lives as long as the value.
const char *opendr_value_type(const struct opendr_value *value);

// The JSON of a target (docs/json.md).
enum opendr_status opendr_value_to_json(const struct opendr_value *value, struct opendr_string **json);

// A target from its JSON (docs/json.md). type is the name of the type that is wanted, or NULL for any.
enum opendr_status opendr_value_from_json(const char *type_name, const char *json, struct opendr_value **value);

// Reads a file as a value of the named type: "Image" (JPEG, PNG, BMP, WebP), "Audio" (WAVE), "Timeseries" (a table of
// numbers as CSV or text, a line a moment; or NPY), "PointCloud" (KITTI's scans), or the JSON of a target.
enum opendr_status opendr_value_open(const char *type_name, const char *path, struct opendr_value **value);

// The value as people read it: a line for each item.
enum opendr_status opendr_value_to_text(const struct opendr_value *value, struct opendr_string **string);

// When the value was taken, nanoseconds; OPENDR_NO_STAMP when that is not known.
enum opendr_status opendr_value_stamp(const struct opendr_value *value, int64_t *stamp_ns);

// Sets when the value was taken; OPENDR_NO_STAMP forgets it.
enum opendr_status opendr_value_set_stamp(struct opendr_value *value, int64_t stamp_ns);

// The coordinate frame of the value; NULL when that is not known. The text lives as long as the value.
const char *opendr_value_frame_id(const struct opendr_value *value);

// Sets the coordinate frame of the value; NULL forgets it.
enum opendr_status opendr_value_set_frame_id(struct opendr_value *value, const char *frame_id);

// A handle of its own to the same value; bulky payloads stay shared.
enum opendr_status opendr_value_copy(const struct opendr_value *value, struct opendr_value **copy);

// Frees the value and makes the variable NULL; a NULL in it is freed already.
enum opendr_status opendr_value_free(struct opendr_value **value);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

/*
 * The same functions for each type X of values: opendr_X_free(), opendr_X_copy(), opendr_X_to_text(), opendr_X_stamp(),
 * opendr_X_set_stamp(), opendr_X_frame_id(), opendr_X_set_frame_id(); see opendr_value_free() and its neighbours.
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

/* For each type X of targets besides: opendr_X_to_json(), opendr_X_from_json() and opendr_X_draw(). */
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

/* For each type X of numbers along axes besides: opendr_X_create() and opendr_X_read(); see opendr_array_create(). */
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
 * and outputs. An output that is not wanted may be NULL.
 */

/*
 * CenterNetDetectorLearner: CenterNet on MobileNetV3 finds the 80 COCO classes; the best of the light detectors here.
 *
 * Parameters:
 *   threshold (a float 0..=1, may change while it runs, default 0.3): Detections below this score are dropped.
 *   iou_threshold (a float 0..=1, may change while it runs, default 0.5): Boxes of one class that overlap more than this (intersection over union) are one object.
 *   max_detections (an int 1..=100, may change while it runs, default 100): At most this many boxes a picture.
 *   suppression (a str, one of hard, soft, fast, cluster, may change while it runs, default hard): How overlapping boxes are thinned out.
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
 * NanodetLearner: NanoDet finds the 80 COCO classes; light, good on small things.
 *
 * Parameters:
 *   threshold (a float 0..=1, may change while it runs, default 0.35): Detections below this score are dropped.
 *   iou_threshold (a float 0..=1, may change while it runs, default 0.6): Boxes of one class that overlap more than this (intersection over union) are one object.
 *   max_detections (an int 1..=1000, may change while it runs, default 100): At most this many boxes a picture.
 *   suppression (a str, one of hard, soft, fast, cluster, may change while it runs, default hard): How overlapping boxes are thinned out.
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
 * SingleShotDetectorLearner: SSD on MobileNetV1, a small detector that trains on classes of your own.
 *
 * Parameters:
 *   threshold (a float 0..=1, may change while it runs, default 0.2): Detections below this score are dropped.
 *   iou_threshold (a float 0..=1, may change while it runs, default 0.45): Boxes of one class that overlap more than this (intersection over union) are one object.
 *   max_candidates (an int 1..=1000, may change while it runs, default 400): So many of the best boxes are looked at before overlapping ones are thinned out.
 *   max_detections (an int 1..=1000, may change while it runs, default 100): At most this many boxes a picture.
 *   suppression (a str, one of hard, soft, fast, cluster, may change while it runs, default hard): How overlapping boxes are thinned out.
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
 * TiledDetectionLearner: Looks at large pictures in tiles with any detector, where it is worth it, within a time budget.
 *
 * Parameters:
 *   threshold (a float 0..=1, may change while it runs, default 0.35): Detections below this score are dropped; the detector is not asked for any below 0.1.
 *   iou_threshold (a float 0..=1, may change while it runs, default 0.5): Boxes of one class from different tiles that overlap more than this (intersection over union) are one object.
 *   max_detections (an int 1..=2000, may change while it runs, default 500): At most this many boxes a picture.
 *   tile (an int 32..=4096 px, may change while it runs, default 256): Side of a tile in the picture. What is looked for should fill a tenth of it or more.
 *   tile_overlap (an int 0..=2048 px, may change while it runs, default 48): What neighbouring tiles share: what is smaller lies whole in one of them. At most half of a tile counts.
 *   whole (a bool, may change while it runs, default true): Whether the whole picture is looked at, too: for what is larger than a tile.
 *   time_budget (a float 0..=60000 ms, may change while it runs, default 0): Time for one picture; a tile that has begun is finished, and one is always looked at. 0: no limit, and answers that depend on nothing but the pictures.
 *   max_tiles (an int 0..=100000, may change while it runs, default 0): At most so many tiles of one picture are looked at, the others in the next ones; 0: no limit.
 *   detail_threshold (a float 0..=255, may change while it runs, default 16): A tile in which brightness differs by no more than this within 16 pixels, 0..=255, is empty; 0: no tile is.
 *   change_threshold (a float 0..=255, may change while it runs, default 6): A tile is looked at again once the brightness of 16 x 16 pixels in it changed by more than this, 0..=255; until then its last answer holds. 0: always.
 *   memory (an int 0..=1000, may change while it runs, default 5): For so many pictures the answer of a tile that changed holds, if there was no time to look again.
 *   rotation (an int 0..=1000, may change while it runs, default 4): In every so-manyth picture the tile that was not looked at for longest is, be there anything or not; 0: never.
 *   parallel_tiles (an int 0..=64, default 0): Tiles that are looked at side by side, each on a thread with a copy of the network; 0: as many as there are cores, at most four.
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
 * Seq2SeqNMSLearner: Tells which of a detector's overlapping boxes to keep, by how they lie and look; it trains.
 *
 * Parameters:
 *   threshold (a float 0..=1, may change while it runs, default 0.1): Boxes whose new score is below this are dropped.
 *   iou_filtering (a float 0..=1, may change while it runs, default 0.8): Of boxes that overlap more than this (intersection over union) only the best is looked at.
 *   max_dt_boxes (an int 1..=1000, may change while it runs, default 400): So many of the best boxes are looked at.
 *
 * Inputs:
 *   image (Image): The picture.
 *   detections (BoundingBoxList): Its boxes before suppression; boxes of classes that the model does not know are left out.
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
 * GemLearner: Finds objects by a colour and an infrared camera and tells which of them to trust; it trains.
 *
 * Parameters:
 *   threshold (a float 0..=1, may change while it runs, default 0.3): Detections below this score are dropped. OpenDR's default of 0.7 is for the scores of DETR.
 *   iou_threshold (a float 0..=1, may change while it runs, default 0.45): Boxes of one class that overlap more than this (intersection over union) are one object.
 *   max_detections (an int 1..=1000, may change while it runs, default 100): At most this many boxes a pair of pictures.
 *
 * Inputs:
 *   colour (Image): The picture in colour. Boxes are in its pixels.
 *   infrared (Image): The picture of the infrared sensor (or of another, as in training), of the same view: sizes may differ, what it shows at a share of its width and height may not.
 *
 * Outputs:
 *   boxes (BoundingBoxList): The objects, in pixels of the picture in colour.
 *   sensors (Category): How much each sensor counted, of sum one: class 0 is colour, 1 infrared (OpenDR's `weight1` and `weight2`).
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
 * VoxelObjectDetection3DLearner: PointPillars finds boxes in the scan of a lidar; it trains on classes of your own.
 *
 * Parameters:
 *   threshold (a float 0..=1, may change while it runs, default 0.3): Boxes below this score are dropped. OpenDR's default of 0 tells every box that the network thinks of.
 *   iou_threshold (a float 0..=1, may change while it runs, default 0.1): Boxes of one class whose floors overlap more than this (intersection over union) are one object.
 *   max_candidates (an int 1..=10000, may change while it runs, default 400): So many of the best boxes are looked at before overlapping ones are thinned out.
 *   max_detections (an int 1..=1000, may change while it runs, default 100): At most this many boxes a scan.
 *
 * Inputs:
 *   point_cloud (PointCloud): What the lidar saw; a PointCloudWithCalibration places the boxes in its camera's frame and picture.
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
 * SortLearner: SORT follows what a detector finds by motion and overlap alone, at next to no cost.
 *
 * Parameters:
 *   threshold (a float 0..=1, may change while it runs, default 0.3): Detections below this score are left out.
 *   iou_threshold (a float 0.01..=1, may change while it runs, default 0.3): A track and a detection may be one object when they overlap at least this much (intersection over union).
 *   max_age (an int 0..=1000, may change while it runs, default 1): Frames for which an object may be out of sight.
 *   min_hits (an int 1..=100, may change while it runs, default 3): An object is told once it was seen in so many frames in a row; in the first frames of a stream at once.
 *   per_class (a bool, may change while it runs, default true): Only boxes of the same class can be one object.
 *
 * Inputs:
 *   detections (BoundingBoxList): What was found in the frame; the confidences count.
 *   image (Image): The frame, which tells how the camera moved. All frames of a stream, or none. NULL leaves it out.
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
 * ByteTrackLearner: ByteTrack follows what a detector finds, through crowds too: detections of low confidence count.
 *
 * Parameters:
 *   threshold (a float 0..=1, may change while it runs, default 0.6): Detections from this score on are paired first.
 *   low_threshold (a float 0..=1, may change while it runs, default 0.1): Detections from this score on only go on with tracks.
 *   new_threshold (a float 0..=1, may change while it runs, default 0.7): A detection begins a track from this score on.
 *   iou_threshold (a float 0.01..=1, may change while it runs, default 0.2): A track and a detection may be one object when their overlap times the score is at least this.
 *   low_iou_threshold (a float 0.01..=1, may change while it runs, default 0.5): The same for detections of a low score, by overlap alone.
 *   track_buffer (an int 0..=1000, may change while it runs, default 30): Frames for which an object may be out of sight.
 *   min_hits (an int 1..=100, may change while it runs, default 2): An object is told once it was seen in so many frames in a row; in the first frames of a stream at once.
 *   per_class (a bool, may change while it runs, default true): Only boxes of the same class can be one object.
 *
 * Inputs:
 *   detections (BoundingBoxList): What was found in the frame; the confidences count.
 *   image (Image): The frame, which tells how the camera moved. All frames of a stream, or none. NULL leaves it out.
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
 * OcSortLearner: OC-SORT follows what a detector finds, through occlusions and uneven motion.
 *
 * Parameters:
 *   threshold (a float 0..=1, may change while it runs, default 0.6): Detections below this score are left out.
 *   iou_threshold (a float 0.01..=1, may change while it runs, default 0.3): A track and a detection may be one object when they overlap at least this much (intersection over union).
 *   max_age (an int 0..=1000, may change while it runs, default 30): Frames for which an object may be out of sight.
 *   min_hits (an int 1..=100, may change while it runs, default 3): An object is told once it was seen in so many frames in a row; in the first frames of a stream at once.
 *   delta_t (an int 1..=10, may change while it runs, default 3): Over so many frames directions are measured.
 *   inertia (a float 0..=1, may change while it runs, default 0.2): How much the direction counts beside the overlap.
 *   per_class (a bool, may change while it runs, default true): Only boxes of the same class can be one object.
 *
 * Inputs:
 *   detections (BoundingBoxList): What was found in the frame; the confidences count.
 *   image (Image): The frame, which tells how the camera moved. All frames of a stream, or none. NULL leaves it out.
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
 * ObjectTracking2DDeepSortLearner: DeepSORT follows the persons that a detector finds and knows them again by how they look.
 *
 * Parameters:
 *   max_dist (a float 0..=2, may change while it runs, default 0.2): Two boxes may show one object when their looks differ at most this much (1 less the cosine).
 *   min_confidence (a float 0..=1, may change while it runs, default 0.3): Detections below this score are left out.
 *   nms_max_overlap (a float 0..=1, may change while it runs, default 0.5): Of boxes that overlap more than this (intersection over union) the best is taken.
 *   max_iou_distance (a float 0..=0.99, may change while it runs, default 0.7): Without looks, a track and a box may be one object when 1 less their overlap is at most this.
 *   max_age (an int 0..=1000, may change while it runs, default 70): Frames for which an object may be out of sight.
 *   n_init (an int 1..=100, may change while it runs, default 3): An object is told once it was seen in so many frames in a row; in the first frames of a stream at once.
 *   nn_budget (an int 1..=200, may change while it runs, default 100): Looks that are remembered of each object.
 *   per_class (a bool, may change while it runs, default true): Only boxes of the same class can be one object.
 *
 * Inputs:
 *   image (Image): The frame.
 *   detections (BoundingBoxList): What was found in it.
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
 * ObjectTracking2DFairMotLearner: NanoDet and ByteTrack in one call follow the persons in a video.
 *
 * Parameters:
 *   threshold (a float 0.1..=1, may change while it runs, default 0.3): Detections from this score on are paired first; 0.1 more begins a track.
 *   track_buffer (an int 0..=1000, may change while it runs, default 30): Frames for which an object may be out of sight.
 *   min_box_area (a float 0..=1000000 px^2, may change while it runs, default 100): Smaller boxes are left out.
 *   every_class (a bool, may change while it runs, default false): Whether all classes of the detector are followed, or persons alone.
 *   camera_motion (a bool, may change while it runs, default true): Whether frames tell how the camera moved; a camera that stands still needs it not.
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
 * SiamRPNLearner: NanoTrack follows one object of any kind from a box in the first frame.
 *
 * Parameters:
 *   window_influence (a float 0..=1, may change while it runs, default 0.455): How much a place far from where the object was is marked down.
 *   penalty (a float 0..=1, may change while it runs, default 0.138): How much another size or shape than before is marked down.
 *   size_rate (a float 0..=1, may change while it runs, default 0.348): How fast the size of the box follows what is seen.
 *
 * Inputs:
 *   image (Image): The frame.
 *   init_box (BoundingBoxList): What is to be followed from this frame on: its first box. Given with the first call of a stream, else NULL.
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
 * ObjectTracking3DAb3dmotLearner: AB3DMOT follows boxes in space by motion and shared volume.
 *
 * Parameters:
 *   max_staleness (an int 1..=1000, may change while it runs, default 2): An object that is out of sight for so many moments is forgotten.
 *   min_updates (an int 1..=100, may change while it runs, default 3): An object is told once it was seen so many moments in a row; in the first moments of a stream at once.
 *   iou_threshold (a float 0..=1, may change while it runs, default 0.01): A track and a box may be one object when they share at least this much of their volume (intersection over union).
 *   per_class (a bool, may change while it runs, default true): Only boxes of the same class can be one object.
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
 * ObjectTracking3DVpitLearner: VPIT follows one object in the scans of a lidar from a box in the first; it trains on recordings.
 *
 * Parameters:
 *   window_influence (a float 0..=1, may change while it runs, default 0.4): How much a place far from where the object is expected is marked down.
 *   rotation_penalty (a float 0..=1, may change while it runs, default 0.98): What the score of another direction than the expected one is multiplied by.
 *   rotation_step (a float 0.01..=1 rad, may change while it runs, default 0.15): How far the directions are apart that are looked at.
 *   rotations_count (an int 1..=9, may change while it runs, default 3): How many directions are looked at, the expected one in their middle; an even number is one more.
 *   context_amount (a float 0..=2, default 0.25): What is seen around an object with it, in its mean sides.
 *   target_feature_merge_scale (a float 0..=1, may change while it runs, default 0): How much of every later view goes into what the object looks like; OpenDR's default is 0, too.
 *   extrapolation_mode (a str, one of linear+, linear, none, may change while it runs, default linear+): What is known of the object's way.
 *   offset_interpolation (a float 0..=1, may change while it runs, default 1): How much of the way to where it is seen the box moves.
 *   vertical_offset_interpolation (a float 0..=1, may change while it runs, default 0.5): The same for its height.
 *   min_top_score (a float 0..=1, may change while it runs, default 0): Below this score the object is out of sight: the box goes where it is expected.
 *
 * Inputs:
 *   point_cloud (PointCloud): What the lidar saw; a PointCloudWithCalibration places the boxes in its camera's frame and picture.
 *   init_box (BoundingBox3DList): What is to be followed from this scan on: its first box. Given with the first call of a stream, else NULL.
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
 * UltraLightFaceLearner: Ultra-Light RFB finds faces in a few milliseconds; boxes only.
 *
 * Parameters:
 *   threshold (a float 0..=1, may change while it runs, default 0.7): Faces below this score are dropped.
 *   iou_threshold (a float 0..=1, may change while it runs, default 0.3): Faces that overlap more than this (intersection over union) are one face.
 *   max_detections (an int 1..=1000, may change while it runs, default 200): At most this many faces a picture.
 *   suppression (a str, one of hard, soft, fast, cluster, may change while it runs, default hard): How overlapping boxes are thinned out.
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
 * YunetLearner: YuNet finds faces with eyes, nose and corners of the mouth; tiny and fast.
 *
 * Parameters:
 *   threshold (a float 0..=1, may change while it runs, default 0.6): Faces below this score are dropped.
 *   iou_threshold (a float 0..=1, may change while it runs, default 0.3): Faces that overlap more than this (intersection over union) are one face.
 *   max_detections (an int 1..=1000, may change while it runs, default 200): At most this many faces a picture.
 *   size (an int 32..=4096 px, default 640): Side of the network's input, for models that take any; a multiple of 32.
 *   suppression (a str, one of hard, soft, fast, cluster, may change while it runs, default hard): How overlapping boxes are thinned out.
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
 * FaceRecognitionLearner: MobileFace tells whose faces a frame shows, after a few reference pictures of each person.
 *
 * Parameters:
 *   threshold (a float -1..=1, may change while it runs, default 0.38): Faces whose cosine with every picture of a known person is below this are unknown.
 *   face_threshold (a float 0..=1, default 0.6): What the detector scores below this is no face.
 *   picture (a str, one of frame, face, may change while it runs, default frame): What pictures show.
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
 * FaceMeshLearner: MediaPipe's face mesh: 468 points of a face and its irises, followed from frame to frame.
 *
 * Parameters:
 *   threshold (a float 0..=1, may change while it runs, default 0.5): Faces of which the mesh is surer than this are answered.
 *   face_threshold (a float 0..=1, default 0.6): What the detector scores below this is no face.
 *   max_faces (an int 1..=50, may change while it runs, default 1): At most this many faces a picture; the detector runs on frames that show fewer.
 *   track (a bool, may change while it runs, default true): Whether faces are followed from frame to frame; else each frame is looked at anew.
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
 * FacialEmotionLearner: mini-XCEPTION tells which of seven emotions the largest face in a frame shows.
 *
 * Parameters:
 *   face_threshold (a float 0..=1, default 0.6): What the detector scores below this is no face.
 *   picture (a str, one of frame, face, may change while it runs, default frame): What pictures show.
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
 * ProgressiveSpatioTemporalBLNLearner: PST-BLN tells an expression by the landmarks of a face through time; it trains.
 *
 * Parameters:
 *   num_class (an int 2..=10000, default none): Classes. None: as many as the data name.
 *   num_point (an int 2..=1000, default none): Landmarks of a face. None: as many as the data have.
 *   in_channels (an int 2..=3, default 2): Coordinates of a landmark: 2 (a third channel, where there is one, holds scores) or 3.
 *   num_frames (an int 1..=10000, default 20): Frames of a clip: the last of a longer recording; in a shorter one, the face stands still before it.
 *   blocksize (an int 1..=256, default 5): Channels of a block.
 *   topology (a list 1..=1000, default 2,2,4,4): Blocks of each layer.
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
 * MovenetLearner: MoveNet finds 18 joints of one person (lightning) or of up to six (multipose).
 *
 * Parameters:
 *   threshold (a float 0..=1, may change while it runs, default 0.2): Persons below this score are dropped.
 *   keypoint_threshold (a float 0..=1, may change while it runs, default 0.1): Joints below this score are missing.
 *   size (an int 128..=1024 px, default 256): Longer side of the input of MultiPose; a multiple of 32. Larger finds smaller persons.
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
 * PosenetLearner: PoseNet finds 18 joints of any number of persons; convolutions only.
 *
 * Parameters:
 *   threshold (a float 0..=1, may change while it runs, default 0.25): Persons below this score are dropped.
 *   keypoint_threshold (a float 0..=1, may change while it runs, default 0.1): Joints below this score are missing.
 *   peak_threshold (a float 0.01..=0.99, may change while it runs, default 0.5): Joints below this score start no person.
 *   nms_radius (a float 0..=200 px, may change while it runs, default 20): Joints of one kind nearer than this belong to one person, in pixels of the network's input.
 *   max_detections (an int 1..=100, may change while it runs, default 20): At most this many persons a picture.
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
 * LightweightOpenPoseLearner: Lightweight OpenPose finds 18 joints of any number of persons and follows them; it trains.
 *
 * Parameters:
 *   threshold (a float 0..=1, may change while it runs, default 0.1): Persons below this score are dropped. The score is the mean of those of the 18 joints; missing ones count as 0.
 *   keypoint_threshold (a float 0.01..=1, may change while it runs, default 0.1): Joints below this score are missing.
 *   base_height (an int 64..=2048 px, may change while it runs, default 256): Height of the network's input; the width follows from the picture. Larger finds smaller persons.
 *   upsample_ratio (an int 1..=8, may change while it runs, default 4): Steps between the cells of the heat maps in which joints are looked for.
 *   track (a bool, may change while it runs, default true): Whether persons keep their identity from frame to frame.
 *   smooth (a bool, may change while it runs, default true): Whether joints are smoothed over frames; needs `track`.
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
 * HighResolutionPoseEstimationLearner: Looks at large pictures twice: coarsely, then closer where persons may be.
 *
 * Parameters:
 *   first_pass_height (an int 64..=2048 px, may change while it runs, default 360): Height of the network's input for the whole picture.
 *   second_pass_height (an int 64..=2048 px, may change while it runs, default 540): Height of the network's input for a part of it, at most; small parts are magnified three times.
 *   method (a str, one of adaptive, primary, may change while it runs, default adaptive): How parts of the picture are chosen.
 *   percentage_around_crop (a float 0..=2, may change while it runs, default 0.3): What is added around a part on each side, as a share of its longer side.
 *   heatmap_threshold (a float 0.01..=1, may change while it runs, default 0.1): Where the coarse heat maps are above this, a closer look is worth it.
 *   detail_threshold (a float 1..=256, may change while it runs, default 32): Where brightness differs by more than this within 4 pixels of the coarse picture, a closer look is worth it too, 0..=255; 256 switches it off.
 *   max_regions (an int 1..=64, may change while it runs, default 4): At most this many parts are looked at in one picture; the others follow in the next frames.
 *   max_pixels (an int 1..=100000000 px, may change while it runs, default 300000): The parts that are looked at in one picture have at most so many pixels for the network, but for the first of them.
 *   threshold (a float 0..=1, may change while it runs, default 0.1): Persons below this score are dropped.
 *   keypoint_threshold (a float 0.01..=1, may change while it runs, default 0.1): Joints below this score are missing.
 *   upsample_ratio (an int 1..=8, may change while it runs, default 4): Steps between the cells of the heat maps in which joints are looked for.
 *   track (a bool, may change while it runs, default true): Whether persons keep their identity from frame to frame.
 *   smooth (a bool, may change while it runs, default true): Whether joints are smoothed over frames; needs `track`.
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
 * BlazePoseLearner: BlazePose finds 33 points of one person and follows them; hands, feet and face among them.
 *
 * Parameters:
 *   threshold (a float 0..=1, may change while it runs, default 0.5): A person below this score is dropped, and followed no longer.
 *   keypoint_threshold (a float 0..=1, may change while it runs, default 0.1): Points that are visible with less than this probability are missing.
 *   looks (an int 1..=4, may change while it runs, default 2): How often a person who is not followed yet is looked at: each look starts from where the one before saw the person.
 *   track (a bool, may change while it runs, default true): Whether the person is followed from frame to frame. Switch it off for single pictures.
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
 * FallDetectorLearner: Tells which persons have fallen, by a rule on their poses over time.
 *
 * Parameters:
 *   hold (a float 0..=60 s, may change while it runs, default 0.5): A posture takes the place of another when it was seen for so long.
 *   threshold (a float 0..=1, may change while it runs, default 0.1): Persons below this score are dropped.
 *   keypoint_threshold (a float 0.01..=1, may change while it runs, default 0.1): Joints below this score are missing.
 *   base_height (an int 64..=2048 px, may change while it runs, default 368): Height of the input of LightweightOpenPose. Larger finds smaller persons; MoveNet has a size of its own.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   falls (BoundingBoxList): A box around each person: class 0 where nothing can be told, 1 for a fall, 2 for none.
 *   poses (PoseList): The persons, in the order of the boxes.
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
 * HandPoseEstimationLearner: Finds 21 joints of each hand and follows hands through a video.
 *
 * Parameters:
 *   max_hands (an int 1..=16, may change while it runs, default 2): At most this many hands a picture.
 *   threshold (a float 0..=1, may change while it runs, default 0.5): Hands below this score are dropped, and followed no longer.
 *   palm_threshold (a float 0..=1, may change while it runs, default 0.2): Palms below this score are not looked at. Lower than MediaPipe's 0.5: a closer look drops what is no hand.
 *   iou_threshold (a float 0..=1, may change while it runs, default 0.3): Palms that overlap more than this (intersection over union) are one palm.
 *   track (a bool, may change while it runs, default true): Whether hands are followed from frame to frame, each with a number. Switch it off for single pictures.
 *   mirrored (a bool, may change while it runs, default false): Whether pictures are mirrored, as those of a selfie are: what looks like a left hand is a right one then.
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
 * KeypointGestureLearner: Tells gestures by the key points of a hand or the path of a finger tip; trains in seconds.
 *
 * Parameters:
 *   hidden (an int 2..=1024, default 32): Features of the first layer; the second has half as many.
 *   dropout (a float 0..=0.9, default 0.1): Share of features that are left out at random in each training step.
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
 * HandGestureLearner: Tells the gestures of the hands in a picture, and in a video those of a pointing finger.
 *
 * Parameters:
 *   threshold (a float 0..=1, may change while it runs, default 0.5): Gestures below this score are dropped.
 *   max_hands (an int 1..=16, default 2): At most this many hands a picture.
 *   track (a bool, default true): Whether hands are followed from frame to frame. Switch it off for single pictures: paths need it.
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
 * ImageClassifierLearner: Tells the class of a picture; learns the classes of a user's own pictures in minutes.
 *
 * Parameters:
 *   probabilities (a bool, may change while it runs, default true): Whether the answer has the score of every class.
 *   softmax (a bool, default true): Whether the network's answer is turned into probabilities by a softmax; false for one that ends in its own.
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
 * MultilinearCompressiveLearner: Tells the class of a picture by few numbers that were measured of it.
 *
 * Parameters:
 *   input_shape (a list 1..=4096, default 32,32,3): Height, width and channels (3) of the pictures that are measured; others are stretched to it.
 *   compressed_shape (a list 1..=4096, default 16,16,1): Height, width and channels of the measurement.
 *   backbone (a str, one of small, default small): What tells the class.
 *   n_class (an int 2..=10000, default none): Classes. None: as many as the data name.
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
 * DeeplabLearner: DeepLab v3 tells the class of every pixel, in 8 bits.
 *
 * Parameters:
 *   full_size (a bool, may change while it runs, default true): Whether the map has the size of the picture; else it has the network's.
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
 * BisenetLearner: BiSeNet tells the class of every pixel; it is trained on a user's own masks.
 *
 * Parameters:
 *   full_size (a bool, may change while it runs, default true): Whether the map has the size of the picture; else it has the network's.
 *   num_classes (an int 2..=255, default none): Classes. None: as many as the data name.
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
 * SelfieSegmentationLearner: Tells a person near the camera from what is behind.
 *
 * Parameters:
 *   threshold (a float 0..=1, may change while it runs, default 0.5): Pixels from this probability on are a person's.
 *   probabilities (a bool, may change while it runs, default false): Whether the map holds probabilities, for blending, instead of classes.
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
 * TiledSegmentationLearner: Tells the class of every pixel of large pictures in tiles, within a time budget.
 *
 * Parameters:
 *   tile (an int 32..=4096 px, may change while it runs, default 512): Side of a tile in the picture. What is looked for should fill a tenth of it or more.
 *   tile_overlap (an int 0..=2048 px, may change while it runs, default 64): What neighbouring tiles share: what is smaller lies whole in one of them. At most half of a tile counts.
 *   whole (a bool, may change while it runs, default true): Whether the whole picture is looked at, too: for what is larger than a tile.
 *   time_budget (a float 0..=60000 ms, may change while it runs, default 0): Time for one picture; a tile that has begun is finished, and one is always looked at. 0: no limit, and answers that depend on nothing but the pictures.
 *   max_tiles (an int 0..=100000, may change while it runs, default 0): At most so many tiles of one picture are looked at, the others in the next ones; 0: no limit.
 *   detail_threshold (a float 0..=255, may change while it runs, default 16): A tile in which brightness differs by no more than this within 16 pixels, 0..=255, is empty; 0: no tile is.
 *   change_threshold (a float 0..=255, may change while it runs, default 6): A tile is looked at again once the brightness of 16 x 16 pixels in it changed by more than this, 0..=255; until then its last answer holds. 0: always.
 *   memory (an int 0..=1000, may change while it runs, default 5): For so many pictures the answer of a tile that changed holds, if there was no time to look again.
 *   rotation (an int 0..=1000, may change while it runs, default 4): In every so-manyth picture the tile that was not looked at for longest is, be there anything or not; 0: never.
 *   parallel_tiles (an int 0..=64, default 0): Tiles that are looked at side by side, each on a thread with a copy of the network; 0: as many as there are cores, at most four.
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
 * BodyPixLearner: BodyPix finds persons with the pixels of each.
 *
 * Parameters:
 *   threshold (a float 0..=1, may change while it runs, default 0.2): Persons below this score are dropped.
 *   mask_threshold (a float 0.01..=0.99, may change while it runs, default 0.5): Pixels from this score on belong to a person.
 *   peak_threshold (a float 0.01..=0.99, may change while it runs, default 0.4): Joints below this score start no person.
 *   nms_radius (a float 0..=200 px, may change while it runs, default 30): Joints of one kind nearer than this belong to one person, in pixels of the network's input.
 *   max_detections (an int 1..=100, may change while it runs, default 20): At most this many persons a picture.
 *   resolution (an int 65..=1537 px, may change while it runs, default 513): Longer side of the network's input. Larger finds smaller persons.
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
 * BinaryHighResolutionLearner: Tells where a picture of full high definition shows what it has learned to look for; it trains.
 *
 * Parameters:
 *   architecture (a str, one of VGG_720p, VGG_1080p, default VGG_720p): The network that is trained; a loaded model is of the one it was trained as.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   map (Heatmap): Probabilities `[rows, columns]`: that of row `y` and column `x` is of the square patch whose left-top corner is (8x, 8y).
 *   category (Category): Class 1 where one of the patches is rather that than class 0, by the probability of the best; of a picture of a patch's size its class.
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
 * EfficientPsLearner: Tells class and object of every pixel, by fusing DeepLab, CenterNet and BodyPix.
 *
 * Parameters:
 *   threshold (a float 0..=1, may change while it runs, default 0.3): Objects below this score are dropped.
 *   box_masks (a bool, may change while it runs, default true): Whether objects of classes that no map of classes knows are the whole of their boxes; else they are left out.
 *   min_overlap (a float 0..=1, may change while it runs, default 0.1): Objects are dropped of whose box the map of classes confirms a smaller share.
 *   min_leftover (a float 0..=1, may change while it runs, default 0.1): Regions of a countable class outside of all boxes are objects from this share of the picture on.
 *   min_stuff (a float 0..=1, may change while it runs, default 0.02): Regions that are not countable are told from this share of the picture on.
 *
 * Inputs:
 *   image (Image)
 *
 * Outputs:
 *   instance (Heatmap): 1000 times the class and the number of the object in its class, from 1; 0 where the class is not countable. 255000 where nothing is known.
 *   semantic (Heatmap): The class of each pixel; 255 where nothing is known.
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
 * EfficientLpsLearner: Tells class and object of every point of a lidar's scan; it trains on labelled scans.
 *
 * Parameters:
 *   things (a list, default ): The classes whose objects are told apart; a model brings those that it was trained with.
 *   projected (a bool, may change while it runs, default false): Whether the answers are maps of the range image's size instead of a number for each point.
 *   max_gap (a float 0.01..=10 m, may change while it runs, default 0.8): Points of neighbouring pixels farther apart than this are of two objects.
 *   min_points (an int 1..=100000, may change while it runs, default 5): Objects of fewer pixels are not told.
 *
 * Inputs:
 *   point_cloud (PointCloud): What the lidar saw; a PointCloudWithCalibration places the boxes in its camera's frame and picture.
 *
 * Outputs:
 *   instance (Heatmap): Of each point (`[points]`) or pixel (`[rows, columns]`): 1000 times the class and the number of the object in its class, from 1; 0 where the class is not countable. 255000 where nothing is known.
 *   semantic (Heatmap): The class; 255 where nothing is known.
 *   depth (Heatmap): Metres, `[rows, columns]`, 0 where there is nothing; empty unless `projected`.
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
 * SemiGlobalMatchingLearner: Tells the distance of what two cameras see, by semi-global matching.
 *
 * Parameters:
 *   min_disparity (an int 0..=4096 px, may change while it runs, default 0): The least disparity that is looked for.
 *   num_disparities (an int 1..=1024 px, may change while it runs, default 64): How many disparities are looked for; rounded up to a multiple of 16.
 *   p1 (an int 0..=193, may change while it runs, default 8): What a step of one pixel in disparity costs, in differing neighbours of 62.
 *   p2 (an int 0..=193, may change while it runs, default 40): What a larger step costs.
 *   uniqueness_ratio (an int 0..=99 %, may change while it runs, default 5): By how many percent the second best disparity must be worse.
 *   disp12_max_diff (an int -1..=1000 px, may change while it runs, default 1): How far the right picture may disagree; -1 does not ask it.
 *   speckle_window_size (an int 0..=1000000 px, may change while it runs, default 100): Islands of at most so many pixels are forgotten.
 *   speckle_range (a float 0..=1000 px, may change while it runs, default 1): Neighbours belong to one island where they differ by at most so much.
 *   fill (a bool, may change while it runs, default false): Whether holes are filled from the background in their row.
 *   shrink (an int 1..=16 px, may change while it runs, default 1): Squares of as many pixels along each side are matched as one: faster, coarser.
 *   focal_length (a float 0..=1000000 px, may change while it runs, default 0): Focal length of the rectified pair. Depths need it.
 *   baseline (a float 0..=1000 m, may change while it runs, default 0): Between the cameras. Depths need it.
 *   disparity_offset (a float -10000..=10000 px, may change while it runs, default 0): How much further right the right principal point lies (Middlebury's doffs).
 *   camera_height (a float 0..=100 m, may change while it runs, default 0): How high the cameras are above the floor. Obstacles need it.
 *   camera_pitch (a float -89..=89 deg, may change while it runs, default 0): How far the cameras look down.
 *   min_height (a float 0..=100 m, may change while it runs, default 0.2): What rises less above the floor is no obstacle.
 *   max_height (a float 0..=100 m, may change while it runs, default 2): What hangs higher above the floor is no obstacle.
 *   max_distance (a float 0.1..=100 m, may change while it runs, default 10): What is farther is no obstacle.
 *
 * Inputs:
 *   left (Image): Of the left camera.
 *   right (Image): Of the right camera.
 *
 * Outputs:
 *   disparity (Heatmap): Disparity of each pixel of the left picture, pixels; 0 where nothing is known.
 *   depth (Heatmap): Distance ahead of each pixel, metres; 0 where nothing is known. Empty without focal length and baseline.
 *   obstacles (BoundingBox3DList): What stands on the floor, nearest first, seen from a level camera at the same place. None without focal length, baseline and camera height.
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
 * AmbiguityMeasureLearner: Tells whether a map of values leaves a doubt where the best place is.
 *
 * Parameters:
 *   threshold (a float 0..=0.999999, may change while it runs, default 0.5): A map is ambiguous where what is left beside the best peak has this probability.
 *   temperature (a float 0.000001..=1000000, may change while it runs, default 1): Of the softmax; larger ones make maps more ambiguous.
 *
 * Inputs:
 *   heatmap (Heatmap)
 *
 * Outputs:
 *   category (Category): Class 1 where it is ambiguous, else 0; the probabilities are those of the best peak and of all others.
 *   peaks (Heatmap): `[peaks, 4]`: row, column, value and probability of each peak, the most persistent first.
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
 * GrConvNetLearner: GR-ConvNet finds where a gripper can take hold, in colour and depth.
 *
 * Parameters:
 *   threshold (a float 0..=1, may change while it runs, default 0.2): Least quality of a grasp.
 *   max_grasps (an int 1..=100, may change while it runs, default 5): Most grasps of a picture.
 *   distance (an int 1..=224 px, may change while it runs, default 20): Least distance between two grasps, pixels of the network's map of 224.
 *
 * Inputs:
 *   image (Image): In colour.
 *   depth (Image): Of the same size and place: one channel, 16 bits in millimetres or floats in metres; 0 where nothing is known.
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
 * SpatioTemporalGCNLearner: ST-GCN tells what a person does from a clip of its moving skeleton; it trains.
 *
 * Parameters:
 *   num_class (an int 2..=10000, default none): Classes. None: as many as the data name.
 *   num_point (an int 2..=1000, default none): Joints. None: as many as the graph has.
 *   num_person (an int 1..=64, default 2): Persons of a recording that are looked at, the first ones; the answer is the mean over those that are there.
 *   in_channels (an int 2..=3, default 3): Coordinates of a joint: 2 (a third channel, where there is one, holds scores) or 3.
 *   graph_type (a str, one of ntu, kinetics, coco, jhmdb, default ntu): Joints and bones.
 *   method_name (a str, one of stgcn, default stgcn): The network.
 *   num_frames (an int 1..=10000, default 300): Frames of a clip: the last of a longer recording; in a shorter one, the person stands still before it.
 *   channels (a list 1..=4096, default 64,64,64,64,128,128,128,256,256,256): Channels of each block.
 *   temporal_kernel (an int 3..=101, default 9): Frames that a block sees; odd.
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
 * CoSTGCNLearner: CoST-GCN tells after every frame what a person does by its moving skeleton; it trains.
 *
 * Parameters:
 *   num_classes (an int 2..=10000, default none): Classes. None: as many as the data name.
 *   num_point (an int 2..=1000, default none): Joints. None: as many as the graph has.
 *   num_person (an int 1..=64, default 2): Persons of a recording that are looked at, the first ones; the answer is the mean over those seen so far.
 *   in_channels (an int 2..=3, default 3): Coordinates of a joint: 2 (a third channel, where there is one, holds scores) or 3.
 *   graph_type (a str, one of ntu, kinetics, coco, jhmdb, default ntu): Joints and bones.
 *   backbone (a str, one of costgcn, default costgcn): The network.
 *   sequence_len (an int 1..=10000, default 300): Frames that an answer speaks of.
 *   channels (a list 1..=4096, default 64,64,64,64,128,128,128,256,256,256): Channels of each block.
 *   temporal_kernel (an int 3..=101, default 9): Frames that a block sees; odd.
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
 * X3DLearner: X3D tells what persons do in a clip; it trains.
 *
 * Parameters:
 *   backbone (a str, one of s, xs, m, l, default s): Frames of a clip, pixels of a frame and depth of the network, where nothing else is given.
 *   num_classes (an int 2..=10000, default none): Classes. None: as many as the data name.
 *   num_frames (an int 1..=256, default none): Frames of a clip, taken evenly from it. None: as the backbone has.
 *   side (an int 32..=1024 px, default none): Pixels of a side of a frame. None: as the backbone has.
 *   width (a float 0.1..=8, default 1): Factor on the channels.
 *   depth (a float 0.1..=8, default none): Factor on the number of blocks. None: as the backbone has.
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
 * CoX3DLearner: CoX3D tells after every picture of a video what persons do; it trains.
 *
 * Parameters:
 *   backbone (a str, one of s, xs, m, l, default s): Frames of a clip, pixels of a frame and depth of the network, where nothing else is given.
 *   num_classes (an int 2..=10000, default none): Classes. None: as many as the data name.
 *   temporal_window_size (an int 1..=256, default none): Frames that an answer is averaged over. None: as the backbone has.
 *   side (an int 32..=1024 px, default none): Pixels of a side of a frame. None: as the backbone has.
 *   width (a float 0.1..=8, default 1): Factor on the channels.
 *   depth (a float 0.1..=8, default none): Factor on the number of blocks. None: as the backbone has.
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
 * AudiovisualEmotionLearner: Tells an emotion by the voice and the face; it trains.
 *
 * Parameters:
 *   num_class (an int 2..=10000, default none): Classes. None: as many as the data name.
 *   seq_length (an int 2..=256, default 15): Frames of the faces, evenly spaced over the video.
 *   fusion (a str, one of ia, it, lt, default ia): How the branches learn of each other.
 *   sample_rate (an int 8000..=48000 Hz, default 22050): Samples of the sound a second.
 *   seconds (a float 0.2..=60 s, default 3.6): Sound that is looked at, from its begin; what is shorter is filled up.
 *
 * Inputs:
 *   audio (Audio): The voice, at the learner's sample rate.
 *   video (Video): The face, cut out, `[3, frames, height, width]`. NULL leaves it out.
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
 * RgbdHandGestureLearner: Tells a hand's gesture by its colour and its distance; it trains.
 *
 * Parameters:
 *   n_class (an int 2..=10000, default none): Classes. None: as many as the data name.
 *   architecture (a str, one of small, default small): The network.
 *
 * Inputs:
 *   image (Image): The picture.
 *   depth (Image): Distances of the same view, one channel: floats in metres, 16 bits in millimetres, 8 bits in centimetres. What is not above 0 is not known.
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
 * GatedRecurrentUnitLearner: A gated recurrent unit tells abnormal heart beats from normal ones.
 *
 * Parameters:
 *   in_channels (an int 1..=1024, default none): Features of a series (leads of a recording). None: as the data have.
 *   series_length (an int 1..=1000000, default none): Instants of a series. None: as the data have.
 *   n_class (an int 2..=10000, default none): Classes. None: as many as the data name.
 *   dropout (a float 0..=0.99, default 0.2): Share of features that are left out at random in each training step.
 *   sample_rate (a float 50..=10000 Hz, default none): Instants a second of a stream, in which beats are found. None: each piece of a stream is a whole series.
 *   recurrent_unit (an int 1..=4096, default 512): Features of the recurrent unit's state.
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
 * AttentionNeuralBagOfFeatureLearner: A bag of learnt features with attention tells abnormal heart beats from normal ones.
 *
 * Parameters:
 *   in_channels (an int 1..=1024, default none): Features of a series (leads of a recording). None: as the data have.
 *   series_length (an int 1..=1000000, default none): Instants of a series. None: as the data have.
 *   n_class (an int 2..=10000, default none): Classes. None: as many as the data name.
 *   dropout (a float 0..=0.99, default 0.2): Share of features that are left out at random in each training step.
 *   sample_rate (a float 50..=10000 Hz, default none): Instants a second of a stream, in which beats are found. None: each piece of a stream is a whole series.
 *   n_codeword (an int 1..=4096, default 256): Learnt features.
 *   quantization_type (a str, one of nbof, tnbof, default nbof): What is put into the bag.
 *   attention_type (a str, one of spatial, temporal, spatialsa, temporalsa, spatiotemporal, default spatial): Over what attention is spread.
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
 * EdgeSpeechNetsLearner: EdgeSpeechNets tell which of a few words was spoken; in four sizes.
 *
 * Parameters:
 *   architecture (a str, one of A, B, C, D, default A): Which network is trained; a loaded model has its own.
 *   output_classes_n (an int 2..=10000, default none): Classes. None: as many as the data name (in OpenDR 20, whatever the data).
 *   preprocess_to_mfcc (a bool, default true): Whether cepstra are made of the input; unset, it is a Timeseries of cepstra already, as many a frame as the network takes.
 *   sample_rate (an int 4000..=384000 Hz, default 16000): Samples a second of the sound.
 *   voice_activity (a str, default none): A container of `silero_vad`: seconds of a stream in which nobody speaks are then not answered, which is the wake-word mode. None: every second is answered.
 *
 * Inputs:
 *   audio (Audio): What was heard; a Timeseries of one feature is taken to be at the learner's sample rate.
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
 * QuadraticSelfOnnLearner: Two layers of quadratic neurons tell which of a few words was spoken.
 *
 * Parameters:
 *   expansion_order (an int 1..=9, default 3): Up to which power neurons take their input, in the network that is trained; a loaded model has its own.
 *   output_classes_n (an int 2..=10000, default none): Classes. None: as many as the data name (in OpenDR 20, whatever the data).
 *   preprocess_to_mfcc (a bool, default true): Whether cepstra are made of the input; unset, it is a Timeseries of cepstra already, as many a frame as the network takes.
 *   sample_rate (an int 4000..=384000 Hz, default 16000): Samples a second of the sound.
 *   voice_activity (a str, default none): A container of `silero_vad`: seconds of a stream in which nobody speaks are then not answered, which is the wake-word mode. None: every second is answered.
 *
 * Inputs:
 *   audio (Audio): What was heard; a Timeseries of one feature is taken to be at the learner's sample rate.
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
 * MatchboxNetLearner: MatchboxNet tells which of a few words was spoken; small and quick.
 *
 * Parameters:
 *   number_of_blocks (an int 1..=64, default 3): Blocks with a way past them (B in the paper).
 *   number_of_subblocks (an int 1..=64, default 1): Convolutions in a block (R in the paper).
 *   number_of_channels (an int 1..=4096, default 64): Channels of the blocks (C in the paper).
 *   output_classes_n (an int 2..=10000, default none): Classes. None: as many as the data name (in OpenDR 20, whatever the data).
 *   preprocess_to_mfcc (a bool, default true): Whether cepstra are made of the input; unset, it is a Timeseries of cepstra already, as many a frame as the network takes.
 *   sample_rate (an int 4000..=384000 Hz, default 16000): Samples a second of the sound.
 *   voice_activity (a str, default none): A container of `silero_vad`: seconds of a stream in which nobody speaks are then not answered, which is the wake-word mode. None: every second is answered.
 *
 * Inputs:
 *   audio (Audio): What was heard; a Timeseries of one feature is taken to be at the learner's sample rate.
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
 * DsCnnLearner: DS-CNN tells twelve words apart, in 52 kB and 8 bits.
 *
 * Parameters:
 *   voice_activity (a str, default none): A container of `silero_vad`: seconds of a stream in which nobody speaks are then not answered, which is the wake-word mode. None: every second is answered.
 *
 * Inputs:
 *   audio (Audio): What was heard; a Timeseries of one feature is taken to be at the learner's sample rate.
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
 * SileroVadLearner: Silero VAD tells whether somebody speaks, 32 ms at a time.
 *
 * Parameters:
 *   threshold (a float 0..=1, may change while it runs, default 0.5): The least probability that speech begins with; it is quiet again 0.15 below.
 *   min_silence_duration_ms (an int 0..=60000 ms, may change while it runs, default 100): How long it must be quiet until speech is over.
 *
 * Inputs:
 *   audio (Audio): What was heard; a Timeseries of one feature is taken to be at the learner's sample rate.
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
 * WhisperLearner: Whisper writes down what was said, with times.
 *
 * Parameters:
 *   temperature (a list 0..=10, may change while it runs, default 0,0.2,0.4,0.6,0.8,1): How random tokens are drawn; the next is tried where the answer to the one before stammers or is unlikely. 0 takes the likeliest.
 *   compression_ratio_threshold (a float 0..=1000, may change while it runs, default 2.4): Text that packs better than this stammers. None: no text does.
 *   logprob_threshold (a float -1000..=0, may change while it runs, default -0.8): Tokens whose logarithms of probabilities have a smaller mean are unlikely. None: none are.
 *   no_speech_threshold (a float 0..=1, may change while it runs, default 0.6): A window that is silent with a higher probability, and whose text is unlikely, has none. None: all have.
 *   condition_on_previous_text (a bool, may change while it runs, default false): Whether the text of a window is what the next begins with: connected, but errors go on too.
 *   language (a str, may change while it runs, default en): What is spoken, e.g. `en`. None: multilingual models find out in the first 30 s.
 *   sample_len (an int 1..=448, may change while it runs, default none): The most tokens of a window. None: 224.
 *   best_of (an int 1..=64, may change while it runs, default none): Texts that are drawn at each temperature above 0, of which the likeliest is taken. None: one.
 *   beam_size (an int 1..=64, may change while it runs, default none): Texts that are followed at temperature 0. None: one, always the likeliest token.
 *   patience (a float 0..=64, may change while it runs, default none): So many times as many texts are finished before such a search ends. None: 1.
 *   length_penalty (a float 0..=1, may change while it runs, default none): How longer texts are preferred (Google's GNMT), 0 to 1. None: by the mean of their tokens.
 *   initial_prompt (a str, may change while it runs, default none): Text that the first window begins behind: names and spellings to be expected.
 *   prefix (a str, may change while it runs, default none): Text that every window begins with.
 *   suppress_tokens (a str, may change while it runs, default -1): Numbers of tokens that are never written, separated by commas; -1 stands for signs that nobody speaks. None: all may be.
 *   suppress_blank (a bool, may change while it runs, default true): Whether no window begins with a space or its end.
 *   without_timestamps (a bool, may change while it runs, default false): Whether segments have no times; then there is one for each window.
 *   max_initial_timestamp (a float 0..=30 s, may change while it runs, default 1): The latest begin of a window's first segment. None: anywhere.
 *   partial_interval (a float 0.5..=30 s, may change while it runs, default 3): How often a stream tells what it understood of a phrase that goes on. None: only phrases that are over.
 *   silence_level (a float 0..=1, may change while it runs, default 0.002): Sound in a stream whose root mean square is lower is silence.
 *
 * Inputs:
 *   audio (Audio): What was heard; a Timeseries of one feature is taken to be at the learner's sample rate.
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
 * PpoLearner: Proximal policy optimisation: the method to begin with, for actions of any kind.
 *
 * Parameters:
 *   deterministic (a bool, may change while it runs, default true): Whether it takes its most likely actions, else some by chance.
 *   seed (an int, default 0): What fixes those by chance, from the beginning of a stream on.
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
 * SacLearner: Soft actor-critic: few steps for continuous actions, where steps are dear.
 *
 * Parameters:
 *   deterministic (a bool, may change while it runs, default true): Whether it takes its most likely actions, else some by chance.
 *   seed (an int, default 0): What fixes those by chance, from the beginning of a stream on.
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
 * Td3Learner: Twin delayed policy gradients: deterministic policies of continuous actions.
 *
 * Parameters:
 *   deterministic (a bool, may change while it runs, default true): Whether it takes its most likely actions, else some by chance.
 *   seed (an int, default 0): What fixes those by chance, from the beginning of a stream on.
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
 * DqnLearner: Deep Q-learning: one choice among few, learnt from steps of the past.
 *
 * Parameters:
 *   deterministic (a bool, may change while it runs, default true): Whether it takes its most likely actions, else some by chance.
 *   seed (an int, default 0): What fixes those by chance, from the beginning of a stream on.
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
 * EndToEndPlanningRLLearner: Flies a drone between obstacles, from its depth camera to heading and yaw.
 *
 * Parameters:
 *   deterministic (a bool, may change while it runs, default true): Whether it takes its most likely actions, else some by chance.
 *   seed (an int, default 0): What fixes those by chance, from the beginning of a stream on.
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

#endif /* OPENDR_H */
