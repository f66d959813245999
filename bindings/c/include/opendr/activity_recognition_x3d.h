#ifndef OPENDR_ACTIVITY_RECOGNITION_X3D_H
#define OPENDR_ACTIVITY_RECOGNITION_X3D_H

/* X3D's network under OpenDR's names; opendr_compat.h explains these headers. */
#include "network_model.h"
#include "target.h"

typedef struct X3dModel {
    void *onnxSession, *env, *sessionOptions; /* the same opendr_network */
    int modelSize;
    int framesPerClip;
    int inChannels;
    int batchSize;
    float meanValue; /* inputs are sample * imgScale + meanValue */
    float imgScale;
    int features; /* number of outputs: classes */
} X3dModelT;

static inline void freeX3dModel(X3dModelT *model) {
    opendr_compat_close(&model->onnxSession);
    memset(model, 0, sizeof *model);
}

/* Loads a network; modelPath "" or NULL loads the pretrained one. mode, "xs", "s", "m" or "l", determines the dynamic
 * axes of the network. */
static inline void loadX3dModel(const char *modelPath, char *mode, X3dModelT *model) {
    static const struct {
        const char *name;
        int side, frames;
    } modes[4] = {{"xs", 160, 4}, {"s", 160, 13}, {"m", 224, 16}, {"l", 312, 16}};
    const opendr_network *network;
    size_t chosen = 0, axes;
    memset(model, 0, sizeof *model);
    while (chosen < 4 && (mode == NULL || strcmp(mode, modes[chosen].name) != 0)) chosen++;
    if (chosen == 4) {
        opendr_compat_fail("loadX3dModel", "mode is none of xs, s, m, l; give one");
        return;
    }
    model->onnxSession = opendr_compat_open("loadX3dModel", modelPath, NULL, "x3d");
    if (model->onnxSession == NULL) return;
    model->env = model->sessionOptions = model->onnxSession;
    network = (const opendr_network *)model->onnxSession;
    axes = opendr_compat_input_axes(network);
    /* [batch, channels, frames, side, side], or without the batch [frames, channels, side, side]. */
    model->batchSize = axes == 4 ? 1 : opendr_compat_input_side(network, 0, 1);
    model->inChannels = opendr_compat_input_side(network, 1, 3);
    model->framesPerClip = opendr_compat_input_side(network, axes == 4 ? 0 : 2, modes[chosen].frames);
    model->modelSize = opendr_compat_input_side(network, axes == 4 ? 3 : 4, modes[chosen].side);
    model->features = opendr_compat_output_side(network, 0, 0, 400);
    if (opendr_compat_is_of(network, "x3d")) {
        model->meanValue = -0.45f / 0.225f;
        model->imgScale = 1.0f / (0.225f * 255.0f);
    } else {
        model->meanValue = -128.0f / 255.0f;
        model->imgScale = 1.0f / 255.0f;
    }
}

/* Runs the network. The tensor is in the order of the network's axes: channels before frames, or frames before channels for a
 * network of four axes. */
static inline void forwardX3d(X3dModelT *model, OpenDRTensorT *tensor, OpenDRTensorVectorT *vector) {
    opendr_compat_forward("forwardX3d", model->onnxSession, OPENDR_COMPAT_CHANNELS_FIRST, tensor, vector);
}

static inline void initRandomOpenDRTensorX3d(OpenDRTensorT *tensor, X3dModelT *model) {
    opendr_compat_random(tensor, model->batchSize, model->framesPerClip, model->inChannels, model->modelSize,
        model->modelSize);
}

/* OpenDR 2's spelling. */
static inline void initRandomOpendrTensorX3d(OpendrTensorT *tensor, X3dModelT *model) {
    initRandomOpenDRTensorX3d(tensor, model);
}

#endif /* OPENDR_ACTIVITY_RECOGNITION_X3D_H */
