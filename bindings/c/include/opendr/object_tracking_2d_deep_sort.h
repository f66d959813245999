#ifndef OPENDR_OBJECT_TRACKING_2D_DEEP_SORT_H
#define OPENDR_OBJECT_TRACKING_2D_DEEP_SORT_H

/* DeepSORT's appearance network under OpenDR's names; opendr_compat.h explains these headers. The tracker is
 * opendr_infer_deep_sort(). */
#include "network_model.h"
#include "target.h"

typedef struct DeepSortModel {
    void *onnxSession, *env, *sessionOptions; /* the same opendr_network */
    int modelSize[2]; /* width and height */
    int inChannels;
    int batchSize;
    float meanValue[3]; /* inputs are (sample / 255 + meanValue) * stdValue */
    float stdValue[3];
    int features; /* length of the output */
} DeepSortModelT;

static inline void freeDeepSortModel(DeepSortModelT *model) {
    opendr_compat_close(&model->onnxSession);
    memset(model, 0, sizeof *model);
}

/* Loads a network; modelPath "" or NULL loads the pretrained one. */
static inline void loadDeepSortModel(const char *modelPath, DeepSortModelT *model) {
    static const float mean[3] = {-0.485f, -0.456f, -0.406f}, std[3] = {0.229f, 0.224f, 0.225f};
    const opendr_network *network;
    memset(model, 0, sizeof *model);
    model->onnxSession = opendr_compat_open("loadDeepSortModel", modelPath, NULL, "deep_sort");
    if (model->onnxSession == NULL) return;
    model->env = model->sessionOptions = model->onnxSession;
    network = (const opendr_network *)model->onnxSession;
    model->batchSize = opendr_compat_input_side(network, 0, 1);
    model->inChannels = opendr_compat_input_side(network, 1, 3);
    model->modelSize[1] = opendr_compat_input_side(network, 2, 128);
    model->modelSize[0] = opendr_compat_input_side(network, 3, 64);
    model->features = opendr_compat_output_side(network, 0, 0, 512);
    for (int i = 0; i < 3; i++) {
        model->meanValue[i] = mean[i];
        model->stdValue[i] = 1.0f / std[i];
    }
}

static inline void forwardDeepSort(DeepSortModelT *model, OpenDRTensorT *tensor, OpenDRTensorVectorT *vector) {
    opendr_compat_forward("forwardDeepSort", model->onnxSession, OPENDR_COMPAT_FRAMES_FIRST, tensor, vector);
}

/* As in OpenDR, the tensor's width is the image's height: the sizes of a tensor are the network's axes in order. */
static inline void initRandomOpenDRTensorDs(OpenDRTensorT *tensor, DeepSortModelT *model) {
    opendr_compat_random(tensor, model->batchSize, 1, model->inChannels, model->modelSize[1], model->modelSize[0]);
}

/* OpenDR 2's spelling. */
static inline void initRandomOpendrTensorDs(OpendrTensorT *tensor, DeepSortModelT *model) {
    initRandomOpenDRTensorDs(tensor, model);
}

#endif /* OPENDR_OBJECT_TRACKING_2D_DEEP_SORT_H */
