#ifndef OPENDR_LIGHTWEIGHT_OPEN_POSE_H
#define OPENDR_LIGHTWEIGHT_OPEN_POSE_H

/* Lightweight OpenPose's network under OpenDR's names; opendr_compat.h explains these headers. For poses use
 * opendr_infer_lightweight_open_pose(). */
#include "network_model.h"
#include "target.h"

typedef struct OpenPoseModel {
    void *onnxSession, *env, *sessionOptions; /* the same opendr_network */
    int modelSize;
    float meanValue; /* inputs are sample * imgScale + meanValue */
    float imgScale;
    int nRefinementStages;
    int outputSize; /* number of outputs, two per stage */
    int stride; /* 0: the maps have stride 8 */
    int evenChannelOutput; /* channels of the first, third, ... output */
    int oddChannelOutput;
    int batchSize;
    int widthOutput;
    int heightOutput;
} OpenPoseModelT;

static inline void freeOpenPoseModel(OpenPoseModelT *model) {
    opendr_compat_close(&model->onnxSession);
    memset(model, 0, sizeof *model);
}

/* Loads a network; modelPath "" or NULL loads the pretrained one. */
static inline void loadOpenPoseModel(const char *modelPath, OpenPoseModelT *model) {
    const opendr_network *network;
    memset(model, 0, sizeof *model);
    model->onnxSession = opendr_compat_open("loadOpenPoseModel", modelPath, NULL, "lightweight_open_pose");
    if (model->onnxSession == NULL) return;
    model->env = model->sessionOptions = model->onnxSession;
    network = (const opendr_network *)model->onnxSession;
    model->batchSize = opendr_compat_input_side(network, 0, 1);
    model->modelSize = opendr_compat_input_side(network, 3, 256);
    model->outputSize = (int)opendr_network_output_count(network);
    model->nRefinementStages = model->outputSize / 2 - 1;
    model->evenChannelOutput = opendr_compat_output_side(network, 0, 2, 19);
    model->oddChannelOutput = opendr_compat_output_side(network, 1, 2, 38);
    model->widthOutput = opendr_compat_output_side(network, 0, 1, model->modelSize / 8);
    model->heightOutput = opendr_compat_output_side(network, 0, 0, model->modelSize / 8);
    if (opendr_compat_is_of(network, "lightweight_open_pose")) {
        model->meanValue = -1.0f;
        model->imgScale = 1.0f / 127.5f;
    } else {
        model->meanValue = -128.0f / 256.0f;
        model->imgScale = 1.0f / 256.0f;
    }
}

static inline void forwardOpenPose(OpenPoseModelT *model, OpenDRTensorT *tensor, OpenDRTensorVectorT *vector) {
    opendr_compat_forward("forwardOpenPose", model->onnxSession, OPENDR_COMPAT_FRAMES_FIRST, tensor, vector);
}

static inline void initRandomOpenDRTensorOp(OpenDRTensorT *tensor, OpenPoseModelT *model) {
    opendr_compat_random(tensor, model->batchSize, 1, 3, model->modelSize, model->modelSize);
}

/* Converts an image to the network's input: resized as a whole, centred, and padded with 0. The channels are BGR, or RGB for a
 * model of this library. */
static inline void initOpenDRTensorFromImgOp(OpenDRImageT *image, OpenDRTensorT *tensor, OpenPoseModelT *model) {
    const int sizes[5] = {1, 1, 3, model->modelSize, model->modelSize};
    opendr_preprocess how;
    float *numbers;
    size_t length;
    freeTensor(tensor);
    if (model->onnxSession == NULL) {
        opendr_compat_fail("initOpenDRTensorFromImgOp", "the model is not loaded; load it first");
        return;
    }
    length = opendr_compat_tensor_length(sizes);
    numbers = length > 0 ? (float *)malloc(length * sizeof(float)) : NULL;
    if (numbers == NULL) return;
    how.width = how.height = (size_t)model->modelSize;
    how.format = opendr_compat_is_of((const opendr_network *)model->onnxSession, "lightweight_open_pose")
        ? OPENDR_RGB
        : OPENDR_BGR;
    how.layout = OPENDR_CHW;
    for (int i = 0; i < 3; i++) {
        how.mean[i] = -model->meanValue / model->imgScale;
        how.std[i] = 1.0f / model->imgScale;
    }
    how.pad = how.mean[0];
    if (opendr_image_preprocess((const opendr_image *)image->data, &how, numbers, length) == OPENDR_OK)
        loadTensor(tensor, numbers, 1, 1, 3, model->modelSize, model->modelSize);
    else
        fprintf(stderr, "initOpenDRTensorFromImgOp: %s\n", opendr_last_error());
    free(numbers);
}

/* OpenDR 2's spelling. */

static inline void initRandomOpendrTensorOp(OpendrTensorT *tensor, OpenPoseModelT *model) {
    initRandomOpenDRTensorOp(tensor, model);
}

static inline void initOpendrTensorFromImgOp(OpendrImageT *image, OpendrTensorT *tensor, OpenPoseModelT *model) {
    initOpenDRTensorFromImgOp(image, tensor, model);
}

#endif /* OPENDR_LIGHTWEIGHT_OPEN_POSE_H */
