#ifndef OPENDR_NETWORK_MODEL_H
#define OPENDR_NETWORK_MODEL_H

/* Shared functions of OpenDR's models that only run a network. These names are not OpenDR's. */
#include <limits.h>

#include "opendr_utils.h"

/* Sets the last error to the message of a failed call, and prints it. */
static inline void opendr_compat_fail(const char *caller, const char *message) {
    opendr_set_last_error(message);
    fprintf(stderr, "%s: %s\n", caller, message);
}

/* Opens an ONNX file, OpenDR's folder of one with its JSON, or a model container. A path of "" or NULL loads the pretrained
 * model of a learner; without a learner (NULL) there is none. Returns NULL if it fails. */
static inline opendr_network *opendr_compat_open(const char *caller, const char *path, const char *device,
    const char *learner) {
    opendr_network *network = NULL;
    opendr_learner *loaded = NULL;
    if (path != NULL && path[0] != '\0') {
        opendr_network_open(path, NULL, device, &network);
    } else if (learner == NULL) {
        opendr_set_last_error("there is no pretrained model; give the path of an ONNX file of your own");
    } else if (opendr_load(learner, NULL, device, NULL, &loaded) == OPENDR_OK) {
        opendr_learner_network(loaded, NULL, &network);
        opendr_learner_free(&loaded);
    }
    if (network == NULL) fprintf(stderr, "%s: %s\n", caller, opendr_last_error());
    return network;
}

static inline void opendr_compat_close(void **network) {
    opendr_network *opened = (opendr_network *)*network;
    opendr_network_free(&opened);
    *network = NULL;
}

/* Returns the length of an axis of the network's first input, or otherwise for a dynamic axis. */
static inline int opendr_compat_input_side(const opendr_network *network, size_t axis, int otherwise) {
    opendr_tensor_info info;
    if (opendr_network_input(network, 0, &info) != OPENDR_OK || axis >= info.axes) return otherwise;
    return info.shape[axis] > 0 && info.shape[axis] <= INT_MAX ? (int)info.shape[axis] : otherwise;
}

/* Returns the number of axes of the network's first input. */
static inline size_t opendr_compat_input_axes(const opendr_network *network) {
    opendr_tensor_info info;
    return opendr_network_input(network, 0, &info) == OPENDR_OK ? info.axes : 0;
}

/* The same for an output, with axes counted from the last. */
static inline int opendr_compat_output_side(const opendr_network *network, size_t index, size_t from_last, int otherwise) {
    opendr_tensor_info info;
    size_t size;
    if (opendr_network_output(network, index, &info) != OPENDR_OK || from_last >= info.axes) return otherwise;
    size = info.shape[info.axes - 1 - from_last];
    return size > 0 && size <= INT_MAX ? (int)size : otherwise;
}

/* Returns whether the network is from a container of this learner. */
static inline bool opendr_compat_is_of(const opendr_network *network, const char *learner) {
    opendr_string *manifest = NULL;
    bool is_of = opendr_network_manifest(network, &manifest) == OPENDR_OK
        && strcmp(opendr_json_text(opendr_string_text(manifest), NULL, "learner", 0), learner) == 0;
    opendr_string_free(&manifest);
    return is_of;
}

/* Fills an initialised tensor with random numbers of -1 to 1; its previous content is freed. */
static inline void opendr_compat_random(OpenDRTensorT *tensor, int batchSize, int frames, int channels, int width,
    int height) {
    const int sizes[5] = {batchSize, frames, channels, width, height};
    size_t length = opendr_compat_tensor_length(sizes);
    float *numbers = length > 0 ? (float *)malloc(length * sizeof(float)) : NULL;
    for (size_t i = 0; numbers != NULL && i < length; i++) numbers[i] = 2.0f * ((float)rand() / (float)RAND_MAX) - 1.0f;
    loadTensor(tensor, numbers, batchSize, frames, channels, width, height);
    free(numbers);
}

/* Returns OpenDR's order of a tensor of five axes for the network. */
typedef enum opendr_compat_order {
    OPENDR_COMPAT_FRAMES_FIRST,
    OPENDR_COMPAT_CHANNELS_FIRST
} opendr_compat_order;

/* Writes the shape of a tensor for a network of this number of axes, 0 for any. If it is below five, leading axes of size 1
 * are dropped. Returns the number of axes. */
static inline size_t opendr_compat_shape(const OpenDRTensorT *tensor, opendr_compat_order order, size_t axes,
    size_t shape[5]) {
    const int frames_first[5] = {tensor->batchSize, tensor->frames, tensor->channels, tensor->width, tensor->height};
    const int channels_first[5] = {tensor->batchSize, tensor->channels, tensor->frames, tensor->width, tensor->height};
    size_t wanted = axes > 0 ? axes : tensor->frames == 1 ? 4 : 5, kept = 0;
    const int *sizes = order == OPENDR_COMPAT_CHANNELS_FIRST && wanted == 5 ? channels_first : frames_first;
    for (size_t i = 0, left = 5; i < 5; i++) {
        if (left > wanted && sizes[i] == 1) left--;
        else shape[kept++] = sizes[i] > 0 ? (size_t)sizes[i] : 0;
    }
    return kept;
}

/* Writes the shape of a tensor of a network as OpenDR's five sizes: four axes are batch, channels, width, height; fewer axes
 * are the last ones; of more, the first are multiplied. Returns whether the sizes fit. */
static inline bool opendr_compat_sizes(const opendr_tensor *tensor, OpenDRTensorT *seen) {
    int *const all[5] = {&seen->batchSize, &seen->frames, &seen->channels, &seen->width, &seen->height};
    size_t sizes[5] = {1, 1, 1, 1, 1};
    for (size_t i = 0; i < tensor->axes; i++) {
        size_t from_last = tensor->axes - 1 - i;
        size_t place = from_last >= 4 || (tensor->axes == 4 && i == 0) ? 0 : 4 - from_last;
        sizes[place] *= tensor->shape[i];
    }
    for (int i = 0; i < 5; i++) {
        if (sizes[i] > INT_MAX) return false;
        *all[i] = (int)sizes[i];
    }
    seen->data = (float *)tensor->numbers; /* read-only */
    return true;
}

/* Runs a network on a tensor. The previous content of the initialised vector is freed; the vector is empty if the run fails. */
static inline void opendr_compat_forward(const char *caller, const void *network, opendr_compat_order order,
    const OpenDRTensorT *tensor, OpenDRTensorVectorT *vector) {
    const opendr_network *opened = (const opendr_network *)network;
    const int sizes[5] = {tensor->batchSize, tensor->frames, tensor->channels, tensor->width, tensor->height};
    opendr_tensors *outputs = NULL;
    OpenDRTensorT *seen = NULL;
    opendr_tensor input;
    size_t shape[5], count = 0, kept = 0;
    freeTensorVector(vector);
    input.name = NULL;
    input.numbers = tensor->data;
    input.length = tensor->data != NULL ? opendr_compat_tensor_length(sizes) : 0;
    input.shape = shape;
    input.axes = opendr_compat_shape(tensor, order, opendr_compat_input_axes(opened), shape);
    if (opendr_network_run(opened, &input, 1, &outputs) != OPENDR_OK) {
        fprintf(stderr, "%s: %s\n", caller, opendr_last_error());
        return;
    }
    count = opendr_tensors_count(outputs);
    seen = (OpenDRTensorT *)calloc(count > 0 ? count : 1, sizeof *seen);
    for (; seen != NULL && kept < count; kept++) {
        opendr_tensor output;
        if (opendr_tensors_get(outputs, kept, &output) != OPENDR_OK || !opendr_compat_sizes(&output, &seen[kept])) break;
    }
    if (seen != NULL && kept == count && count <= INT_MAX) loadTensorVector(vector, seen, (int)count);
    else opendr_compat_fail(caller, "the outputs do not fit in tensors of OpenDR");
    opendr_tensors_free(&outputs);
    free(seen);
}

#endif /* OPENDR_NETWORK_MODEL_H */
