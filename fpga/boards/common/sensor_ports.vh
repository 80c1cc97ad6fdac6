// The last ports of every top: a sensor's and an image processor's, for a board that has them.
`ifdef HALFROW_SENSOR
    ,
    input  wire        camera_pixclk,
    input  wire        camera_frame_valid,
    input  wire        camera_line_valid,
    input  wire [11:0] camera_data,
    output wire        isp_pixclk,
    output wire        isp_frame_valid,
    output wire        isp_line_valid,
    output wire [11:0] isp_data
`endif
