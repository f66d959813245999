#ifndef OPENDR_OPENDR_UTILS_H
#define OPENDR_OPENDR_UTILS_H

/* Loading and freeing under OpenDR's names; opendr_compat.h explains these headers. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../opendr.h"
#include "data.h"
#include "target.h"

/* Return values of the JSON of a model; "" or 0 if missing. A text is valid until the next such call of the thread. */

static inline const char *jsonGetStringFromKey(const char *json, const char *key, int index) {
    return opendr_json_text(json, NULL, key, index);
}

static inline float jsonGetFloatFromKey(const char *json, const char *key, int index) {
    return (float)opendr_json_number(json, NULL, key, index);
}

static inline const char *jsonGetStringFromKeyInInferenceParams(const char *json, const char *key, int index) {
    return opendr_json_text(json, "inference_params", key, index);
}

static inline float jsonGetFloatFromKeyInInferenceParams(const char *json, const char *key, int index) {
    return (float)opendr_json_number(json, "inference_params", key, index);
}

/* OpenDR 2's spelling. */

static inline const char *jsonGetKeyString(const char *json, const char *key, int index) {
    return jsonGetStringFromKey(json, key, index);
}

static inline float jsonGetKeyFloat(const char *json, const char *key, int index) {
    return jsonGetFloatFromKey(json, key, index);
}

static inline float jsonGetKeyFromInferenceParams(const char *json, const char *key, int index) {
    return jsonGetFloatFromKeyInInferenceParams(json, key, index);
}

/* Images. */

/* Reads an image; data is NULL if it fails. */
static inline void loadImage(const char *path, OpenDRImageT *image) {
    opendr_image *opened = NULL;
    if (opendr_image_open(path, &opened) != OPENDR_OK) fprintf(stderr, "loadImage: %s\n", opendr_last_error());
    image->data = opened;
}

static inline void freeImage(OpenDRImageT *image) {
    opendr_image *opened = (opendr_image *)image->data;
    opendr_image_free(&opened);
    image->data = NULL;
}

/* Detections; an empty vector has one detection with the name -1. */

static inline void freeDetectionsVector(OpenDRDetectionVectorTargetT *vector) {
    free(vector->startingPointer);
    vector->startingPointer = NULL;
    vector->size = 0;
}

/* Copies detections into an initialised vector; its previous content is freed. */
static inline void loadDetectionsVector(OpenDRDetectionVectorTargetT *vector, OpenDRDetectionTargetT *detections,
    int count) {
    size_t size = (size_t)(count > 0 ? count : 0) * sizeof *detections;
    OpenDRDetectionTargetT *copy = (OpenDRDetectionTargetT *)malloc(size > 0 ? size : 1);
    if (copy != NULL && size > 0) memcpy(copy, detections, size);
    freeDetectionsVector(vector);
    vector->startingPointer = copy;
    vector->size = copy == NULL || count < 0 ? 0 : count;
}

static inline void initDetectionsVector(OpenDRDetectionVectorTargetT *vector) {
    OpenDRDetectionTargetT none = {-1, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
    vector->startingPointer = NULL;
    loadDetectionsVector(vector, &none, 1);
}

/* Tensors. */

static inline void initTensor(OpenDRTensorT *tensor) {
    memset(tensor, 0, sizeof *tensor);
}

static inline void freeTensor(OpenDRTensorT *tensor) {
    free(tensor->data);
    initTensor(tensor);
}

/* Returns the count of numbers of a tensor of these sizes; 0, with a warning on stderr, if a size is not positive or the
 * tensor does not fit in memory. */
static inline size_t opendr_compat_tensor_length(const int sizes[5]) {
    size_t length = 1;
    for (int i = 0; i < 5; i++) {
        if (sizes[i] <= 0 || length > SIZE_MAX / sizeof(float) / (size_t)sizes[i]) {
            fprintf(stderr, "loadTensor: sizes must be positive and fit in memory\n");
            return 0;
        }
        length *= (size_t)sizes[i];
    }
    return length;
}

/* Copies numbers into an initialised tensor; its previous content is freed. The tensor is empty if a size is not positive. */
static inline void loadTensor(OpenDRTensorT *tensor, void *data, int batchSize, int frames, int channels, int width,
    int height) {
    const int sizes[5] = {batchSize, frames, channels, width, height};
    size_t length = data != NULL ? opendr_compat_tensor_length(sizes) : 0;
    float *copy = length > 0 ? (float *)malloc(length * sizeof(float)) : NULL;
    if (copy != NULL) memcpy(copy, data, length * sizeof(float));
    freeTensor(tensor);
    if (copy == NULL) return;
    tensor->data = copy;
    tensor->batchSize = batchSize;
    tensor->frames = frames;
    tensor->channels = channels;
    tensor->width = width;
    tensor->height = height;
}

static inline void initTensorVector(OpenDRTensorVectorT *vector) {
    memset(vector, 0, sizeof *vector);
}

static inline void freeTensorVector(OpenDRTensorVectorT *vector) {
    for (int i = 0; i < vector->nTensors; i++) free(vector->datas[i]);
    free(vector->batchSizes); /* one block for all sizes */
    free(vector->datas);
    initTensorVector(vector);
}

/* Copies tensors into an initialised vector; its previous content is freed. */
static inline void loadTensorVector(OpenDRTensorVectorT *vector, OpenDRTensorT *tensors, int count) {
    size_t places = (size_t)(count > 0 ? count : 0);
    int *sizes = (int *)calloc(places > 0 ? places : 1, 5 * sizeof(int));
    float **datas = (float **)calloc(places > 0 ? places : 1, sizeof(float *));
    OpenDRTensorVectorT loaded;
    initTensorVector(&loaded);
    if (sizes == NULL || datas == NULL) {
        free(sizes);
        free(datas);
        freeTensorVector(vector);
        return;
    }
    loaded.batchSizes = sizes;
    loaded.frames = sizes + places;
    loaded.channels = sizes + 2 * places;
    loaded.widths = sizes + 3 * places;
    loaded.heights = sizes + 4 * places;
    loaded.datas = datas;
    for (; loaded.nTensors < count; loaded.nTensors++) {
        int i = loaded.nTensors;
        OpenDRTensorT copy;
        initTensor(&copy);
        loadTensor(&copy, tensors[i].data, tensors[i].batchSize, tensors[i].frames, tensors[i].channels, tensors[i].width,
            tensors[i].height);
        loaded.batchSizes[i] = copy.batchSize;
        loaded.frames[i] = copy.frames;
        loaded.channels[i] = copy.channels;
        loaded.widths[i] = copy.width;
        loaded.heights[i] = copy.height;
        loaded.datas[i] = copy.data;
    }
    freeTensorVector(vector);
    *vector = loaded;
}

/* Copies tensor index of a vector into an initialised tensor, which is empty if the index is out of range. */
static inline void iterTensorVector(OpenDRTensorT *tensor, OpenDRTensorVectorT *vector, int index) {
    if (index < 0 || index >= vector->nTensors) {
        freeTensor(tensor);
        return;
    }
    loadTensor(tensor, vector->datas[index], vector->batchSizes[index], vector->frames[index], vector->channels[index],
        vector->widths[index], vector->heights[index]);
}

/* Texts. */

static inline void initOpenDRStringsVector(OpenDRStringsVectorT *vector) {
    vector->data = NULL;
    vector->size = 0;
}

static inline void freeStringsVector(OpenDRStringsVectorT *vector) {
    for (int i = 0; i < vector->size; i++) free(vector->data[i]);
    free(vector->data);
    initOpenDRStringsVector(vector);
}

/* Copies texts into an initialised vector; its previous content is freed. */
static inline void loadOpenDRStringsVector(OpenDRStringsVectorT *vector, const char **texts, int count) {
    OpenDRStringsVectorT loaded;
    initOpenDRStringsVector(&loaded);
    loaded.data = (char **)calloc((size_t)(count > 0 ? count : 1), sizeof(char *));
    for (; loaded.data != NULL && loaded.size < count; loaded.size++) {
        const char *text = texts[loaded.size] != NULL ? texts[loaded.size] : "";
        char *copy = (char *)malloc(strlen(text) + 1);
        if (copy == NULL) break;
        strcpy(copy, text);
        loaded.data[loaded.size] = copy;
    }
    freeStringsVector(vector);
    *vector = loaded;
}

#endif /* OPENDR_OPENDR_UTILS_H */
