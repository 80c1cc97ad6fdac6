// What every top has besides the pins of its link and the bridge: `board`, and the nets between the two. Included in the top's body
// behind `oscillator`. Without a sensor the top has none of its pins.
`ifdef HALFROW_SENSOR
    localparam SENSOR = 1;
`else
    localparam SENSOR = 0;

    wire        camera_pixclk = 1'b0;
    wire        camera_frame_valid = 1'b0;
    wire        camera_line_valid = 1'b0;
    wire [11:0] camera_data = 12'd0;
    wire        isp_pixclk, isp_frame_valid, isp_line_valid;
    wire [11:0] isp_data;
    wire        unused = &{1'b0, isp_pixclk, isp_frame_valid, isp_line_valid, isp_data};
`endif

    (* KEEP = "TRUE" *) wire link_clk;         // named in the constraints of a board with a sensor
    wire        link_rst, clk, rst, millisecond, session_open, packet_seen, camera_fault, quiet;
    wire        taken_frame_valid, taken_line_valid, made_frame_valid, made_line_valid;
    wire [11:0] taken_data, made_data;
    wire [7:0]  clock_source;
    wire [31:0] clock_hz;
    wire [63:0] serial;
    wire        unused_quiet = &{1'b0, quiet};

    board #(.SENSOR(SENSOR)) board (
        .oscillator(oscillator), .link_clk(link_clk), .link_rst(link_rst), .clk(clk), .rst(rst), .millisecond(millisecond),
        .clock_source(clock_source), .clock_hz(clock_hz), .serial(serial),
        .session_open(session_open), .packet_seen(packet_seen), .camera_fault(camera_fault), .lamps(led),
        .pin_pixclk(camera_pixclk), .pin_frame_valid(camera_frame_valid), .pin_line_valid(camera_line_valid),
        .pin_data(camera_data),
        .camera_frame_valid(taken_frame_valid), .camera_line_valid(taken_line_valid), .camera_data(taken_data),
        .isp_frame_valid(made_frame_valid), .isp_line_valid(made_line_valid), .isp_data(made_data),
        .pin_isp_pixclk(isp_pixclk), .pin_isp_frame_valid(isp_frame_valid), .pin_isp_line_valid(isp_line_valid),
        .pin_isp_data(isp_data));
