#ifndef OPENDR_TARGET_H
#define OPENDR_TARGET_H

/* Targets under OpenDR's names; opendr_compat.h explains these headers. */

typedef struct OpenDRCategoryTarget {
    int data;
    float confidence;
} OpenDRCategoryTargetT;

typedef struct OpenDRDetectionTarget {
    int name;
    float left, top, width, height, score;
} OpenDRDetectionTargetT;

typedef struct OpenDRDetectionVectorTarget {
    OpenDRDetectionTargetT *startingPointer;
    int size;
} OpenDRDetectionVectorTargetT;

/* OpenDR 2's spelling. */
typedef OpenDRCategoryTargetT OpendrCategoryTargetT;
typedef OpenDRDetectionTargetT OpendrDetectionTargetT;
typedef OpenDRDetectionVectorTargetT OpendrDetectionVectorTargetT;

#endif /* OPENDR_TARGET_H */
