// What more than one module of the board has to know and what is not on the wire. Included in a module's body.

// L of fpga/DATAPATH.md, which halfrow_core's pipeline has with so many taps.
function integer latency_of(input integer taps);
    latency_of = taps == 7 ? 12 : 11;
endfunction

// Rows with a grid that are narrower than so many columns need so many pixel clocks between them, in which the next
// one's values are found; fpga/checks/grid_bench.cpp holds halfrow_core to it.
localparam GRID_WIDTH = 144;
localparam GRID_BLANKING = 32;

// Bits that number so many things from 0 on, at least one.
function integer bits_for(input integer things);
    for (bits_for = 1; (1 << bits_for) < things; bits_for = bits_for + 1) ;
endfunction

// The greatest frame that the datapath can have.
localparam GREATEST_WIDTH = 2592;
localparam GREATEST_HEIGHT = 2048;

// Of bursts: records, and the fewest pixel clocks between two frames, in which the last record is made.
localparam BURST_RECORDS = 16;
localparam LEAST_FRAME_BLANKING = 256;

// B
localparam [1:0] DEPTH_8 = 2'd0;
localparam [1:0] DEPTH_10 = 2'd1;
localparam [1:0] DEPTH_12 = 2'd2;

// Where halfrow_reply gets the bytes of a payload.
localparam [2:0] FROM_PACKET = 3'd0;
localparam [2:0] FROM_HELLO = 3'd1;
localparam [2:0] FROM_CAPABILITIES = 3'd2;
localparam [2:0] FROM_STATUS = 3'd3;
localparam [2:0] FROM_TABLE = 3'd4;
localparam [2:0] FROM_CRC = 3'd5;
localparam [2:0] FROM_COMMIT = 3'd6;
localparam [2:0] FROM_REFUSAL = 3'd7;

// What halfrow_table_port does with entries.
localparam [1:0] TASK_CHECK = 2'd0;
localparam [1:0] TASK_WRITE = 2'd1;
localparam [1:0] TASK_READ = 2'd2;
localparam [1:0] TASK_WIPE = 2'd3;
