/* Helper functions of the programs that run a network. */
#include "opendr_utils.h"

/* Fills a tensor with 0, 1/8, ... 7/8 repeatedly, the input that the test gives ONNX Runtime, too. */
static inline void fill(OpenDRTensorT *tensor) {
    size_t length = (size_t)tensor->batchSize * (size_t)tensor->frames * (size_t)tensor->channels * (size_t)tensor->width
        * (size_t)tensor->height;
    for (size_t i = 0; i < length; i++) tensor->data[i] = (float)(i % 8) / 8.0f;
}

/* Prints one line per tensor: its shape, its first values and the mean of all values. */
static inline void print_tensors(OpenDRTensorVectorT *vector) {
    for (int i = 0; i < vector->nTensors; i++) {
        OpenDRTensorT tensor;
        double sum = 0.0;
        int length;
        initTensor(&tensor);
        iterTensorVector(&tensor, vector, i);
        printf("%d %d %d %d %d:", tensor.batchSize, tensor.frames, tensor.channels, tensor.width, tensor.height);
        for (int number = 0; number < 4; number++) printf(" %.9g", (double)tensor.data[number]);
        length = tensor.batchSize * tensor.frames * tensor.channels * tensor.width * tensor.height;
        for (int number = 0; number < length; number++) sum += (double)tensor.data[number];
        printf(" %.9g\n", sum / length);
        freeTensor(&tensor);
    }
}
