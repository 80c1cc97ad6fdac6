// The numbers of protocol/WIRE.md, by the page's names. Included in a module's body. fpga/checks/wire.py holds them to
// the page.
localparam [7:0] WIRE_VERSION = 8'd1;
localparam [31:0] WIRE_MAGIC = 32'h31575248;          // "HRW1", the first byte in [7:0]
localparam [15:0] DATAPATH_ID = 16'd1;                // of fpga/DATAPATH.md
localparam [15:0] GRID_DATAPATH_ID = 16'd2;           // of its section "Datapath 2"
localparam [15:0] CONTENT_ID = 16'd1;                 // of fpga/AT-SPEED.md

localparam [7:0] KIND_HELLO = 8'h00;
localparam [7:0] KIND_CAPABILITIES = 8'h01;
localparam [7:0] KIND_STATUS = 8'h02;
localparam [7:0] KIND_RESET = 8'h03;
localparam [7:0] KIND_ECHO = 8'h04;
localparam [7:0] KIND_TABLE_WRITE = 8'h10;
localparam [7:0] KIND_TABLE_READ = 8'h11;
localparam [7:0] KIND_TABLE_CRC = 8'h12;
localparam [7:0] KIND_COMMIT = 8'h13;
localparam [7:0] KIND_CONFIGURE = 8'h18;
localparam [7:0] KIND_ROW_IN = 8'h20;
localparam [7:0] KIND_ROW_OUT = 8'h21;
localparam [7:0] KIND_ROW_ACK = 8'h22;
localparam [7:0] KIND_BURST = 8'h30;
localparam [7:0] KIND_RECORDS = 8'h31;
localparam [7:0] KIND_EXPECT = 8'h32;
localparam [7:0] KIND_TRAP = 8'h33;
localparam [7:0] KIND_REFUSAL = 8'h7f;

localparam [3:0] REFUSAL_VERSION = 4'd1;
localparam [3:0] REFUSAL_KIND = 4'd2;
localparam [3:0] REFUSAL_PAYLOAD = 4'd3;
localparam [3:0] REFUSAL_RANGE = 4'd4;
localparam [3:0] REFUSAL_SESSION = 4'd5;
localparam [3:0] REFUSAL_HELD = 4'd6;
localparam [3:0] REFUSAL_BUSY = 4'd7;
localparam [3:0] REFUSAL_NOT_READY = 4'd8;
localparam [3:0] REFUSAL_TABLE_CRC = 4'd9;
localparam [3:0] REFUSAL_CREDIT = 4'd10;
localparam [3:0] REFUSAL_ROW = 4'd11;
localparam [3:0] REFUSAL_TAPS = 4'd12;

localparam [7:0] TAG_DATAPATH = 8'h01;
localparam [7:0] TAG_MAX_WIDTH = 8'h02;
localparam [7:0] TAG_MAX_HEIGHT = 8'h03;
localparam [7:0] TAG_DEPTHS = 8'h04;
localparam [7:0] TAG_TAPS = 8'h05;
localparam [7:0] TAG_LATENCY = 8'h06;
localparam [7:0] TAG_RING = 8'h07;
localparam [7:0] TAG_LEAST_BLANKING = 8'h08;
localparam [7:0] TAG_TABLE_BANKS = 8'h09;
localparam [7:0] TAG_ROW_BANKS_IN = 8'h0a;
localparam [7:0] TAG_ROW_BANKS_OUT = 8'h0b;
localparam [7:0] TAG_STEP_PORTS = 8'h0c;
localparam [7:0] TAG_KERNEL_PORTS = 8'h0d;
localparam [7:0] TAG_CLOCK_SOURCE = 8'h0e;
localparam [7:0] TAG_CLOCK_HZ = 8'h0f;
localparam [7:0] TAG_CONTENT = 8'h10;
localparam [7:0] TAG_ENTERED = 8'h11;
localparam [7:0] TAG_FURTHER_DATAPATH = 8'h12;
localparam [7:0] TAG_NATURE = 8'h20;
localparam [7:0] TAG_NAME = 8'h21;

localparam [7:0] CLOCK_HOST = 8'd0;
localparam [7:0] CLOCK_PIXCLK = 8'd1;
localparam [7:0] CLOCK_PLL = 8'd2;

localparam [7:0] NATURE_HARDWARE = 8'd1;
localparam [7:0] NATURE_SIMULATION = 8'd2;
localparam [7:0] NATURE_MOCK = 8'd3;

localparam [3:0] COUNTER_PACKETS = 4'd0;
localparam [3:0] COUNTER_CRC_ERRORS = 4'd1;
localparam [3:0] COUNTER_FRAMING_ERRORS = 4'd2;
localparam [3:0] COUNTER_FOREIGN_PACKETS = 4'd3;
localparam [3:0] COUNTER_REFUSALS = 4'd4;
localparam [3:0] COUNTER_ROWS_IN = 4'd5;
localparam [3:0] COUNTER_ROWS_OUT = 4'd6;
localparam [3:0] COUNTER_ROWS_REPEATED = 4'd7;
localparam [3:0] COUNTER_ROWS_UNNEEDED = 4'd8;
localparam [3:0] COUNTER_SAMPLES_OVER = 4'd9;
localparam [3:0] COUNTER_NEXT_ROW_IN = 4'd10;
localparam [3:0] COUNTER_NEXT_ROW_OUT = 4'd11;
localparam [3:0] COUNTER_CORE_BUSY = 4'd12;
localparam [3:0] COUNTER_GENERATION = 4'd13;
localparam [3:0] COUNTER_LEAST_LATENCY = 4'd14;
localparam [3:0] COUNTER_MOST_LATENCY = 4'd15;

localparam [7:0] RESET_CLOSES = 8'd1;                 // level 1: the session, too
localparam [7:0] RESET_WIPES = 8'd2;                  // level 2: configuration and tables, too; the greatest

localparam [1:0] TABLE_STEPS = 2'd0;
localparam [1:0] TABLE_KERNEL = 2'd1;
localparam [1:0] TABLE_GRID = 2'd3;

localparam [15:0] SPAN_BYTES = 16'd7;
localparam [4:0] RECORD_BYTES = 5'd18;
localparam [15:0] MOST_PAYLOAD = 16'd4080;            // bytes
localparam NODES = 65;
localparam [15:0] LEAST_WIDTH = 16'd64;
