#ifndef OPENDR_DATA_H
#define OPENDR_DATA_H

/* Images and tensors under OpenDR's names; opendr_compat.h explains these headers. */

typedef struct OpenDRImage {
    void *data; /* an opendr_image */
} OpenDRImageT;

typedef struct OpenDRTensor {
    int batchSize, frames, channels, width, height;
    float *data; /* the last axis, height, is contiguous */
} OpenDRTensorT;

typedef struct OpenDRTensorVector {
    int nTensors;
    int *batchSizes, *frames, *channels, *widths, *heights;
    float **datas;
} OpenDRTensorVectorT;

typedef struct OpenDRStringsVector {
    char **data;
    int size;
} OpenDRStringsVectorT;

/* OpenDR 2's spelling. */
typedef OpenDRImageT OpendrImageT;
typedef OpenDRTensorT OpendrTensorT;
typedef OpenDRTensorVectorT OpendrTensorVectorT;

#endif /* OPENDR_DATA_H */
